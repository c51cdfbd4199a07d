#include "platform/tools/programming/reach_check.hpp"

#include <algorithm>
#include <random>

#include "platform/input_error.hpp"
#include "platform/tools/programming/inverse_kinematics.hpp"

namespace glint {
namespace {

struct Fault {
  ReachFault fault = ReachFault::unreachable;
  int joint = -1;
};

// What is possible at one point in any configuration.
struct PointSolutions {
  std::optional<Fault> fault;          // without any valid solution
  std::vector<KDL::JntArray> valid{};  // distinct
};

class StrokeCheck {
 public:
  StrokeCheck(const std::vector<UncertainPose>& points, const PathCheckSettings& settings,
              InverseKinematics& solver)
      : points_(points), settings_(settings), solver_(solver), solutions_(points.size()) {}

  struct Followed {
    std::vector<std::optional<Fault>> faults;  // one entry for each point
    ElementJoints joints;
  };

  // `last` is the initial guess, and the last valid position on return.
  Followed run(std::optional<KDL::JntArray>& last) {
    Followed start{std::vector<std::optional<Fault>>(points_.size()),
                   ElementJoints(points_.size())};
    std::size_t first = 0;
    for (; first < points_.size(); ++first) {
      if (last && usable(first, *last)) break;
      start.faults[first] = at(first).fault;
      if (!start.faults[first]) break;
    }
    if (first == points_.size()) return start;
    std::optional<Followed> best;
    const auto attempt = [&](const KDL::JntArray& joints) {
      Followed found = start;
      found.joints[first] = joints;
      follow(first, found);
      const std::size_t faults = count(found.faults);
      if (!best || faults < count(best->faults)) best = std::move(found);
      return faults == first;
    };
    bool done = false;
    if (last && usable(first, *last))
      done = attempt(solver_.solve(points_[first].pose, *last).joints);
    if (!done) {
      for (const KDL::JntArray& joints : at(first).valid) {
        if (attempt(joints)) break;
      }
    }
    for (const auto& joints : best->joints) {
      if (joints) last = joints;
    }
    return *best;
  }

 private:
  static std::size_t count(const std::vector<std::optional<Fault>>& faults) {
    return static_cast<std::size_t>(
        std::count_if(faults.begin(), faults.end(), [](const auto& f) { return f.has_value(); }));
  }

  [[nodiscard]] bool in_workspace(std::size_t i) const {
    if (!settings_.workspace_m) return true;
    const std::array<double, 6>& box = *settings_.workspace_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = points_[i].pose.translation[static_cast<int>(axis)];
      if (value < box[axis] || value > box[axis + 3]) return false;
    }
    return true;
  }

  std::optional<Fault> fault_of(const JointSolution& solution) const {
    if (!solution.converged) return Fault{ReachFault::unreachable};
    if (solution.beyond_joint >= 0) return Fault{ReachFault::joint_limit, solution.beyond_joint};
    if (solution.singular_value < settings_.singular_value_min) return Fault{ReachFault::singular};
    return {};
  }

  bool usable(std::size_t i, const KDL::JntArray& guess) {
    return in_workspace(i) && !fault_of(solver_.solve(points_[i].pose, guess));
  }

  // Solutions from all guesses, computed once. The fault is that of the solution that is nearest to
  // a valid one: singular, then the smallest excess of a limit.
  const PointSolutions& at(std::size_t i) {
    if (solutions_[i]) return *solutions_[i];
    PointSolutions found{Fault{ReachFault::unreachable}};
    if (!in_workspace(i)) {
      found.fault = Fault{ReachFault::outside_workspace};
      return *(solutions_[i] = found);
    }
    std::mt19937 random(1);
    double smallest_excess = 0;
    for (int n = 0; n < settings_.guesses_max; ++n) {
      const JointSolution one = solver_.solve(points_[i].pose, solver_.random_guess(random));
      const std::optional<Fault> fault = fault_of(one);
      if (!fault) {
        add_distinct(found.valid, one.joints);
      } else if (fault->fault == ReachFault::singular) {
        found.fault = fault;
      } else if (fault->fault == ReachFault::joint_limit &&
                 found.fault->fault != ReachFault::singular &&
                 (found.fault->fault == ReachFault::unreachable || one.beyond < smallest_excess)) {
        found.fault = fault;
        smallest_excess = one.beyond;
      }
    }
    if (!found.valid.empty()) found.fault.reset();
    return *(solutions_[i] = found);
  }

  static void add_distinct(std::vector<KDL::JntArray>& list, const KDL::JntArray& joints) {
    constexpr double k_equal = 0.01;  // rad or m: far above the tolerances of a solution
    const bool known = std::any_of(list.begin(), list.end(), [&](const KDL::JntArray& other) {
      return (other.data - joints.data).cwiseAbs().maxCoeff() < k_equal;
    });
    if (!known) list.push_back(joints);
  }

  // Follows the points after `first` from its joint positions.
  void follow(std::size_t first, Followed& followed) {
    std::size_t valid = first;
    for (std::size_t i = first + 1; i < points_.size(); ++i) {
      const KDL::JntArray& joints = *followed.joints[valid];
      const JointSolution next = solver_.solve(points_[i].pose, joints);
      const double step_max = settings_.joint_step_max * static_cast<double>(i - valid);
      const bool near = next.converged && largest_step(joints, next.joints).first <= step_max;
      std::optional<Fault> fault = fault_of(next);
      if (in_workspace(i) && near && !fault) {
        followed.joints[i] = next.joints;
        valid = i;
      } else if (at(i).fault) {
        followed.faults[i] = at(i).fault;  // of every configuration
      } else if (near) {
        followed.faults[i] = fault;  // of this configuration
      } else {
        const KDL::JntArray& changed = nearest(at(i).valid, joints);
        followed.faults[i] = Fault{ReachFault::joint_step, largest_step(joints, changed).second};
        followed.joints[i] = changed;
        valid = i;
      }
    }
  }

  static std::pair<double, int> largest_step(const KDL::JntArray& from, const KDL::JntArray& to) {
    Eigen::Index joint = 0;
    const double step = (to.data - from.data).cwiseAbs().maxCoeff(&joint);
    return {step, static_cast<int>(joint)};
  }

  static const KDL::JntArray& nearest(const std::vector<KDL::JntArray>& list,
                                      const KDL::JntArray& joints) {
    return *std::min_element(list.begin(), list.end(), [&](const auto& a, const auto& b) {
      return largest_step(joints, a).first < largest_step(joints, b).first;
    });
  }

  const std::vector<UncertainPose>& points_;
  const PathCheckSettings& settings_;
  InverseKinematics& solver_;
  std::vector<std::optional<PointSolutions>> solutions_;
};

}  // namespace

FollowedPath follow_path(const DrawnPath& path, const KinematicChain& chain,
                         const PathCheckSettings& settings) {
  std::optional<KDL::JntArray> last;
  if (!settings.start.empty()) {
    if (settings.start.size() != chain.joints.size()) {
      throw InputError(std::to_string(settings.start.size()) + " start positions; expected " +
                       std::to_string(chain.joints.size()) + ", one for each joint to '" +
                       chain.tip + "'");
    }
    last = KDL::JntArray(static_cast<unsigned>(chain.joints.size()));
    std::copy(settings.start.begin(), settings.start.end(), last->data.data());
  }
  InverseKinematics solver(chain, settings.solver);
  FollowedPath followed;
  for (std::size_t e = 0; e < path.size(); ++e) {
    auto [faults, joints] = StrokeCheck(path[e].points, settings, solver).run(last);
    followed.joints.push_back(std::move(joints));
    for (std::size_t p = 0; p < faults.size(); ++p) {
      if (!faults[p]) continue;
      const int joint = faults[p]->joint;
      followed.failures.push_back({e + 1, p + 1, faults[p]->fault,
                                   joint < 0 ? "" : chain.joints[static_cast<std::size_t>(joint)]});
    }
  }
  return followed;
}

std::vector<ReachFailure> check_reach(const DrawnPath& path, const KinematicChain& chain,
                                      const PathCheckSettings& settings) {
  return follow_path(path, chain, settings).failures;
}

std::string point_text(const DrawnPath& path, std::size_t element, std::size_t point) {
  const std::string number = std::to_string(element);
  if (path[element - 1].kind == PathKind::waypoint) return "waypoint " + number;
  return "stroke " + number + ", point " + std::to_string(point);
}

std::string failure_text(const DrawnPath& path, const ReachFailure& failure) {
  const std::string place = point_text(path, failure.element, failure.point);
  switch (failure.fault) {
    case ReachFault::outside_workspace:
      return place + ": outside of the workspace";
    case ReachFault::joint_limit:
      return place + ": joint limit of " + failure.joint;
    case ReachFault::singular:
      return place + ": singular";
    case ReachFault::joint_step:
      return place + ": step of joint " + failure.joint;
    default:
      return place + ": unreachable";
  }
}

}  // namespace glint
