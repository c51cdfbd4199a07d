# SUNDIALS' archives: found where Glint is built, and again where its installed library is used.
find_library(GLINT_SUNDIALS_ARKODE libsundials_arkode.a REQUIRED)
find_library(GLINT_SUNDIALS_GENERIC libsundials_generic.a REQUIRED)
add_library(Glint::sundials INTERFACE IMPORTED GLOBAL)
set_target_properties(Glint::sundials PROPERTIES
  INTERFACE_LINK_LIBRARIES "${GLINT_SUNDIALS_ARKODE};${GLINT_SUNDIALS_GENERIC}")
