#include "platform/tools/calibrate/motion_equations.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <stdexcept>

#include "kernels/motion/motion_state.hpp"

namespace glint {
namespace {

constexpr double k_relative = 1e-6;
// Relative to each component's own sigma: digits far below it do not matter.
constexpr double k_absolute = 1e-6;
constexpr long k_steps_max = 20'000;

struct Problem {
  MotionPart part;
  MotionUnknowns unknowns;
};

using ConstMean = Eigen::Map<const Vector9>;
using Mean = Eigen::Map<Vector9>;

double* data_of(N_Vector vector) { return N_VGetArrayPointer(vector); }

// The axes of a translation are equal and independent: one axis's triangle of the covariance is
// stored. The state vector holds the mean, then the triangle row by row.
int width_of(MotionPart part) { return part == MotionPart::shift ? 3 : 9; }
int size_of(MotionPart part) { return 9 + width_of(part) * (width_of(part) + 1) / 2; }

void pack(MotionPart part, const Matrix9& p, N_Vector vector) {
  const int width = width_of(part), step = 9 / width;
  double* out = data_of(vector) + 9;
  for (int r = 0; r < width; ++r)
    for (int c = r; c < width; ++c) *out++ = p(step * r, step * c);
}

Matrix9 unpacked(MotionPart part, N_Vector vector) {
  const int width = width_of(part), step = 9 / width;
  const double* in = data_of(vector) + 9;
  Matrix9 p = Matrix9::Zero();
  for (int r = 0; r < width; ++r) {
    for (int c = r; c < width; ++c, ++in) {
      for (int axis = 0; axis < step; ++axis)
        p(step * r + axis, step * c + axis) = p(step * c + axis, step * r + axis) = *in;
    }
  }
  return p;
}

void write(MotionPart part, const Moments& moments, N_Vector vector) {
  Mean(data_of(vector)) = moments.mean;
  pack(part, moments.covariance, vector);
}

void read(MotionPart part, N_Vector vector, Moments& moments) {
  moments.mean = ConstMean(data_of(vector));
  moments.covariance = unpacked(part, vector);
}

Vector9 mean_rate(const Vector9& mean, double damping) {
  Vector9 rate;
  rate << mean.segment<3>(3), mean.segment<3>(6), -damping * mean.segment<3>(6);
  return rate;
}

// F P with the F of the header; `turn`: [angular speed]x, zero for a translation.
Matrix9 mean_covariance_rate(const Matrix9& p, double damping, const Matrix3& turn) {
  Matrix9 rate;
  rate.topRows<3>() = p.middleRows<3>(3);
  rate.topRows<3>().noalias() += turn * p.topRows<3>();
  rate.middleRows<3>(3) = p.bottomRows<3>();
  rate.bottomRows<3>() = -damping * p.bottomRows<3>();
  return rate;
}

Matrix3 turn_of(MotionPart part, const Vector9& mean) {
  return part == MotionPart::rotation ? cross_matrix(mean.segment<3>(3)) : Matrix3::Zero();
}

int rates(realtype, N_Vector at, N_Vector out, void* user) {
  const auto& problem = *static_cast<const Problem*>(user);
  const Vector9 mean = ConstMean(data_of(at));
  const double damping = problem.unknowns.damping;
  const Matrix9 half =
      mean_covariance_rate(unpacked(problem.part, at), damping, turn_of(problem.part, mean));
  Matrix9 covariance = half + half.transpose();
  covariance.diagonal().tail<3>().array() += problem.unknowns.noise;
  Mean(data_of(out)) = mean_rate(mean, damping);
  pack(problem.part, covariance, out);
  return 0;
}

// Derivatives of the equations: F times the sensitivity, plus the derivative of F times the state.
int sensitive_rates(int, realtype, N_Vector at, N_Vector, N_Vector* s, N_Vector* out, void* user,
                    N_Vector, N_Vector) {
  const auto& problem = *static_cast<const Problem*>(user);
  const Vector9 mean = ConstMean(data_of(at));
  const Matrix9 p = unpacked(problem.part, at);
  const double damping = problem.unknowns.damping;
  const Matrix3 turn = turn_of(problem.part, mean);
  for (int i = 0; i < k_motion_unknowns; ++i) {
    const Vector9 mean_s = ConstMean(data_of(s[i]));
    Vector9 mean_out = mean_rate(mean_s, damping);
    Matrix9 half = mean_covariance_rate(unpacked(problem.part, s[i]), damping, turn);
    half.topRows<3>() += turn_of(problem.part, mean_s) * p.topRows<3>();
    if (i == 1) {  // by ln damping
      mean_out.tail<3>() -= damping * mean.tail<3>();
      half.bottomRows<3>() -= damping * p.bottomRows<3>();
    }
    Matrix9 covariance = half + half.transpose();
    if (i == 0) covariance.diagonal().tail<3>().array() += problem.unknowns.noise;
    Mean(data_of(out[i])) = mean_out;
    pack(problem.part, covariance, out[i]);
  }
  return 0;
}

}  // namespace

struct MotionEquations::Body {
  Problem problem;
  SUNContext context = nullptr;
  N_Vector state = nullptr, tolerance = nullptr;
  N_Vector* sensitivities = nullptr;
  void* memory = nullptr;
  SUNNonlinearSolver state_solver =
      nullptr;  // solver of the state alone: CVODES requires it; unused
  SUNNonlinearSolver sensitivity_solver = nullptr;

  explicit Body(MotionPart part) : problem{part, {}} {
    if (SUNContext_Create(nullptr, &context) != 0) return;
    state = N_VNew_Serial(size_of(part), context);
    tolerance = N_VClone(state);
    sensitivities = N_VCloneVectorArray(k_motion_unknowns, state);
    memory = CVodeCreate(CV_ADAMS, context);
    state_solver = SUNNonlinSol_FixedPoint(state, 0, context);
    sensitivity_solver = SUNNonlinSol_FixedPointSens(k_motion_unknowns + 1, state, 0, context);
  }
  ~Body() {
    if (memory != nullptr) CVodeFree(&memory);
    for (SUNNonlinearSolver solver : {state_solver, sensitivity_solver})
      if (solver != nullptr) SUNNonlinSolFree(solver);
    if (sensitivities != nullptr) N_VDestroyVectorArray(sensitivities, k_motion_unknowns);
    for (N_Vector vector : {state, tolerance})
      if (vector != nullptr) N_VDestroy(vector);
    if (context != nullptr) SUNContext_Free(&context);
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  [[nodiscard]] bool prepared() {
    if (memory == nullptr || state_solver == nullptr || sensitivity_solver == nullptr ||
        sensitivities == nullptr)
      return false;
    N_VConst(0, state);
    for (int i = 0; i < k_motion_unknowns; ++i) N_VConst(0, sensitivities[i]);
    return CVodeInit(memory, rates, 0, state) == CV_SUCCESS &&
           CVodeSetUserData(memory, &problem) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(memory, k_steps_max) == CV_SUCCESS &&
           CVodeSensInit(memory, k_motion_unknowns, CV_SIMULTANEOUS, sensitive_rates,
                         sensitivities) == CV_SUCCESS &&
           CVodeSetSensErrCon(memory, SUNTRUE) == CV_SUCCESS &&
           CVodeSetNonlinearSolver(memory, state_solver) == CV_SUCCESS &&
           CVodeSetNonlinearSolverSensSim(memory, sensitivity_solver) == CV_SUCCESS &&
           CVodeSetErrFile(memory, nullptr) == CV_SUCCESS;
  }

  // Tolerances from the initial sigmas, which only increase until the next measurement.
  [[nodiscard]] bool set_tolerances(const Matrix9& p) {
    const Vector9 sigma = p.diagonal().cwiseMax(1e-300).cwiseSqrt();
    Mean(data_of(tolerance)) = k_absolute * sigma;
    pack(problem.part, k_absolute * sigma * sigma.transpose(), tolerance);
    N_Vector both[k_motion_unknowns] = {tolerance, tolerance};
    return CVodeSVtolerances(memory, k_relative, tolerance) == CV_SUCCESS &&
           CVodeSensSVtolerances(memory, k_relative, both) == CV_SUCCESS;
  }
};

MotionEquations::MotionEquations(MotionPart part) : body_(std::make_unique<Body>(part)) {
  if (!body_->prepared()) throw std::runtime_error("SUNDIALS cannot be prepared: no memory");
}

MotionEquations::~MotionEquations() = default;

bool MotionEquations::propagate(SensitiveMoments& moments, double seconds,
                                const MotionUnknowns& unknowns) {
  Body& body = *body_;
  body.problem.unknowns = unknowns;
  write(body.problem.part, moments.value, body.state);
  for (int i = 0; i < k_motion_unknowns; ++i)
    write(body.problem.part, moments.by[static_cast<std::size_t>(i)], body.sensitivities[i]);
  realtype reached = 0;
  const bool carried_on =
      body.set_tolerances(moments.value.covariance) &&
      CVodeReInit(body.memory, 0, body.state) == CV_SUCCESS &&
      CVodeSensReInit(body.memory, CV_SIMULTANEOUS, body.sensitivities) == CV_SUCCESS &&
      CVodeSetStopTime(body.memory, seconds) == CV_SUCCESS &&
      CVode(body.memory, seconds, body.state, &reached, CV_NORMAL) >= 0 &&
      CVodeGetSens(body.memory, &reached, body.sensitivities) == CV_SUCCESS;
  if (!carried_on) return false;
  read(body.problem.part, body.state, moments.value);
  for (int i = 0; i < k_motion_unknowns; ++i)
    read(body.problem.part, body.sensitivities[i], moments.by[static_cast<std::size_t>(i)]);
  return true;
}

}  // namespace glint
