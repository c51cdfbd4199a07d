#include "platform/calibrate/motion_equations.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <stdexcept>

#include "kernels/motion/motion_state.hpp"

namespace glint {
namespace {

constexpr int k_size = 9 + 81;  // mean, covariance
constexpr double k_relative = 1e-8;
// Of what a start after a gap holds: a metre or radian a second.
constexpr double k_absolute = 1e-13;
constexpr long k_steps_max = 20'000;

struct Problem {
  MotionPart part;
  MotionUnknowns unknowns;
};

using ConstMean = Eigen::Map<const Vector9>;
using Mean = Eigen::Map<Vector9>;
using ConstCovariance = Eigen::Map<const Matrix9>;
using Covariance = Eigen::Map<Matrix9>;

double* data_of(N_Vector vector) { return N_VGetArrayPointer(vector); }

void write(const Moments& moments, N_Vector vector) {
  Mean(data_of(vector)) = moments.mean;
  Covariance(data_of(vector) + 9) = moments.covariance;
}

void read(N_Vector vector, Moments& moments) {
  moments.mean = ConstMean(data_of(vector));
  const ConstCovariance covariance(data_of(vector) + 9);
  moments.covariance = 0.5 * (covariance + covariance.transpose());
}

Vector9 mean_rate(const Vector9& mean, double damping) {
  Vector9 rate;
  rate << mean.segment<3>(3), mean.segment<3>(6), -damping * mean.segment<3>(6);
  return rate;
}

// F P, F as above; `turn`: [angular speed]x, zero for a shift.
Matrix9 carried(const Matrix9& p, double damping, const Matrix3& turn) {
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
      carried(ConstCovariance(data_of(at) + 9), damping, turn_of(problem.part, mean));
  Mean(data_of(out)) = mean_rate(mean, damping);
  Covariance covariance(data_of(out) + 9);
  covariance = half + half.transpose();
  covariance.diagonal().tail<3>().array() += problem.unknowns.noise;
  return 0;
}

// The equations' derivatives: F by the sensitivity, and F's own derivative by the state's.
int sensitive_rates(int, realtype, N_Vector at, N_Vector, N_Vector* s, N_Vector* out, void* user,
                    N_Vector, N_Vector) {
  const auto& problem = *static_cast<const Problem*>(user);
  const Vector9 mean = ConstMean(data_of(at));
  const Matrix9 p = ConstCovariance(data_of(at) + 9);
  const double damping = problem.unknowns.damping;
  const Matrix3 turn = turn_of(problem.part, mean);
  for (int i = 0; i < k_motion_unknowns; ++i) {
    const Vector9 mean_s = ConstMean(data_of(s[i]));
    Vector9 mean_out = mean_rate(mean_s, damping);
    Matrix9 half = carried(ConstCovariance(data_of(s[i]) + 9), damping, turn);
    half.topRows<3>() += turn_of(problem.part, mean_s) * p.topRows<3>();
    if (i == 1) {  // by ln damping
      mean_out.tail<3>() -= damping * mean.tail<3>();
      half.bottomRows<3>() -= damping * p.bottomRows<3>();
    }
    Mean(data_of(out[i])) = mean_out;
    Covariance covariance(data_of(out[i]) + 9);
    covariance = half + half.transpose();
    if (i == 0) covariance.diagonal().tail<3>().array() += problem.unknowns.noise;
  }
  return 0;
}

}  // namespace

struct MotionEquations::Body {
  Problem problem;
  SUNContext context = nullptr;
  N_Vector state = nullptr;
  N_Vector* sensitivities = nullptr;
  void* memory = nullptr;
  SUNNonlinearSolver solver = nullptr;

  explicit Body(MotionPart part) : problem{part, {}} {
    if (SUNContext_Create(nullptr, &context) != 0) return;
    state = N_VNew_Serial(k_size, context);
    sensitivities = N_VCloneVectorArray(k_motion_unknowns, state);
    memory = CVodeCreate(CV_ADAMS, context);
    solver = SUNNonlinSol_FixedPointSens(k_motion_unknowns + 1, state, 0, context);
  }
  ~Body() {
    if (memory != nullptr) CVodeFree(&memory);
    if (solver != nullptr) SUNNonlinSolFree(solver);
    if (sensitivities != nullptr) N_VDestroyVectorArray(sensitivities, k_motion_unknowns);
    if (state != nullptr) N_VDestroy(state);
    if (context != nullptr) SUNContext_Free(&context);
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  [[nodiscard]] bool prepared() {
    if (memory == nullptr || solver == nullptr || sensitivities == nullptr) return false;
    N_VConst(0, state);
    for (int i = 0; i < k_motion_unknowns; ++i) N_VConst(0, sensitivities[i]);
    realtype absolute[k_motion_unknowns];
    std::fill(absolute, absolute + k_motion_unknowns, k_absolute);
    return CVodeInit(memory, rates, 0, state) == CV_SUCCESS &&
           CVodeSStolerances(memory, k_relative, k_absolute) == CV_SUCCESS &&
           CVodeSetUserData(memory, &problem) == CV_SUCCESS &&
           CVodeSetMaxNumSteps(memory, k_steps_max) == CV_SUCCESS &&
           CVodeSensInit(memory, k_motion_unknowns, CV_SIMULTANEOUS, sensitive_rates,
                         sensitivities) == CV_SUCCESS &&
           CVodeSensSStolerances(memory, k_relative, absolute) == CV_SUCCESS &&
           CVodeSetSensErrCon(memory, SUNTRUE) == CV_SUCCESS &&
           CVodeSetNonlinearSolverSensSim(memory, solver) == CV_SUCCESS &&
           CVodeSetErrFile(memory, nullptr) == CV_SUCCESS;
  }
};

MotionEquations::MotionEquations(MotionPart part) : body_(std::make_unique<Body>(part)) {
  if (!body_->prepared()) throw std::runtime_error("SUNDIALS could not be prepared: no memory");
}

MotionEquations::~MotionEquations() = default;

bool MotionEquations::carry(SensitiveMoments& moments, double seconds,
                            const MotionUnknowns& unknowns) {
  Body& body = *body_;
  body.problem.unknowns = unknowns;
  write(moments.value, body.state);
  for (int i = 0; i < k_motion_unknowns; ++i)
    write(moments.by[static_cast<std::size_t>(i)], body.sensitivities[i]);
  realtype reached = 0;
  const bool carried_on =
      CVodeReInit(body.memory, 0, body.state) == CV_SUCCESS &&
      CVodeSensReInit(body.memory, CV_SIMULTANEOUS, body.sensitivities) == CV_SUCCESS &&
      CVodeSetStopTime(body.memory, seconds) == CV_SUCCESS &&
      CVode(body.memory, seconds, body.state, &reached, CV_NORMAL) >= 0 &&
      CVodeGetSens(body.memory, &reached, body.sensitivities) == CV_SUCCESS;
  if (!carried_on) return false;
  read(body.state, moments.value);
  for (int i = 0; i < k_motion_unknowns; ++i)
    read(body.sensitivities[i], moments.by[static_cast<std::size_t>(i)]);
  return true;
}

}  // namespace glint
