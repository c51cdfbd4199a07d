# Cross builds for the arm64 board against the sysroot that platform/apps/board/sysroot makes.
#   cmake --preset arm64        or -DCMAKE_TOOLCHAIN_FILE=platform/apps/board/aarch64.cmake
# GLINT_SYSROOT: where the sysroot is; by default sysroot in the build folder.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

# CMake tries the compiler in folders of their own, which need this variable too.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES GLINT_SYSROOT)
set(GLINT_SYSROOT "${CMAKE_BINARY_DIR}/sysroot" CACHE PATH "arm64 packages to build against")
if(NOT EXISTS ${GLINT_SYSROOT}/made-of)
  message(FATAL_ERROR "no sysroot in ${GLINT_SYSROOT}; make it: platform/apps/board/sysroot ${GLINT_SYSROOT}")
endif()
set(CMAKE_SYSROOT ${GLINT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH ${GLINT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# Libraries of libraries, which Debian's do not name with a path.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${GLINT_SYSROOT}/usr/lib/aarch64-linux-gnu")

# The board's programs run here by an emulator named by name: no kernel setting decides.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static;-cpu;cortex-a72;-L;${GLINT_SYSROOT})

# Only what the board runs, and its tests: no OpenCV.
set(GLINT_BOARD_ONLY ON CACHE BOOL "Leave out what needs OpenCV" FORCE)
