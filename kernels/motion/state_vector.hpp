// SUNDIALS N_Vector of fixed length, whose operations are plain loops that the compiler can unroll.
//
// SUNDIALS' own serial vector reads its length in every operation, which takes most of a step's
// time. Only integrate_motion.cpp includes this file.
//
// Source: Hindmarsh et al. 2005, SUNDIALS; user-supplied N_Vector by the documentation of version
//         6.4: the operations that ERKStep needs, with its linear sum and linear combination.
#pragma once

#include <sundials/sundials_nvector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

namespace glint {

template <int N>
struct StateVector {
  using Values = std::array<double, static_cast<std::size_t>(N)>;

  static Values& of(N_Vector v) { return *static_cast<Values*>(v->content); }

  // Returns null if an allocation fails.
  static N_Vector make(SUNContext context) {
    N_Vector v = N_VNewEmpty(context);
    if (v == nullptr) return nullptr;
    v->content = new (std::nothrow) Values{};
    if (v->content == nullptr) {
      N_VFreeEmpty(v);
      return nullptr;
    }
    N_Vector_Ops ops = v->ops;
    ops->nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
    ops->nvclone = [](N_Vector w) { return make(w->sunctx); };
    ops->nvdestroy = destroy;
    ops->nvgetlength = [](N_Vector) -> sunindextype { return N; };
    ops->nvspace = [](N_Vector, sunindextype* reals, sunindextype* integers) {
      *reals = N;
      *integers = 1;
    };
    ops->nvlinearsum = [](double a, N_Vector x, double b, N_Vector y, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = a * of(x)[i] + b * of(y)[i];
    };
    ops->nvconst = [](double c, N_Vector z) { of(z).fill(c); };
    ops->nvprod = [](N_Vector x, N_Vector y, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = of(x)[i] * of(y)[i];
    };
    ops->nvdiv = [](N_Vector x, N_Vector y, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = of(x)[i] / of(y)[i];
    };
    ops->nvscale = [](double c, N_Vector x, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = c * of(x)[i];
    };
    ops->nvabs = [](N_Vector x, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = std::abs(of(x)[i]);
    };
    ops->nvinv = [](N_Vector x, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = 1 / of(x)[i];
    };
    ops->nvaddconst = [](N_Vector x, double b, N_Vector z) {
      for (std::size_t i = 0; i < N; ++i) of(z)[i] = of(x)[i] + b;
    };
    ops->nvmaxnorm = [](N_Vector x) {
      double largest = 0;
      for (const double value : of(x)) largest = std::max(largest, std::abs(value));
      return largest;
    };
    ops->nvwrmsnorm = [](N_Vector x, N_Vector w) {
      double sum = 0;
      for (std::size_t i = 0; i < N; ++i) sum += of(x)[i] * of(w)[i] * of(x)[i] * of(w)[i];
      return std::sqrt(sum / N);
    };
    ops->nvmin = [](N_Vector x) { return *std::min_element(of(x).begin(), of(x).end()); };
    ops->nvlinearcombination = combine;
    return v;
  }

 private:
  static void destroy(N_Vector v) {
    if (v == nullptr) return;
    delete &of(v);
    v->content = nullptr;
    N_VFreeEmpty(v);
  }

  // z = sum c_k x_k, summed in the order of k; z may alias x_0.
  static int combine(int count, double* c, N_Vector* x, N_Vector z) {
    Values sum;
    for (std::size_t i = 0; i < N; ++i) sum[i] = c[0] * of(x[0])[i];
    for (int k = 1; k < count; ++k)
      for (std::size_t i = 0; i < N; ++i) sum[i] += c[k] * of(x[k])[i];
    of(z) = sum;
    return 0;
  }
};

}  // namespace glint
