#include "platform/tools/inspect/explainer.hpp"

#include <algorithm>
#include <bit>

#include "kernels/pose/camera_model.hpp"

namespace glint {
namespace {

// A hand moves at most this long in its last direction.
constexpr Duration k_extrapolation_max = milliseconds(300);
constexpr Duration k_frame_gap_max = milliseconds(500);

}  // namespace

Explainer::Explainer(const Cell& cell) : cell_(cell), examiner_(cell) {
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    tools_[t].newest.tool = static_cast<std::uint8_t>(t);
  }
}

void Explainer::add_arrival(Time mid_exposure, Time arrival) noexcept {
  any_frame_ = true;
  arrival_ = arrival;
  frame_age_ = arrival - mid_exposure;
  refused_ = Reason::none;
}

void Explainer::add_refused(Time arrival, Reason reason) noexcept {
  any_frame_ = true;
  arrival_ = arrival;
  refused_ = is_overrun(reason) ? Reason::none : reason;
}

bool Explainer::examines(Time arrival) const noexcept { return arrival >= next_examination_; }

const ExaminedFrame& Explainer::add_frame(const Frame& frame) {
  add_arrival(frame.mid_exposure, frame.arrival);
  next_examination_ = frame.arrival + k_examination_period;
  examined_ = examiner_.examine(frame);
  const Estimates& estimates = examiner_.tracker().output<Estimates>();
  for (std::size_t t = 0; t < static_cast<std::size_t>(cell_.tools.count); ++t) {
    ToolState& tool = tools_[t];
    tool.found = estimates.tracks[t].measured_now;
    if (tool.found) add_sighting(estimates.tracks[t], tool);
    tool.left_view = tool.found ? LeftView::no : left_view_of(t, frame.mid_exposure);
  }
  diagnose_next_tool();
  return *examined_;
}

void Explainer::add_sighting(const Track& track, ToolState& tool) const {
  const bool world = head_.valid;
  const Sighting now{track.newest.time, world ? ReferenceFrame::world : ReferenceFrame::camera,
                     world ? head_.T_world_camera * track.T_camera_tool : track.T_camera_tool};
  tool.before = tool.last;
  if (tool.before && tool.before->base != now.base) tool.before.reset();
  tool.last = now;
  tool.cause.reset();
}

LeftView Explainer::left_view_of(std::size_t tool, Time time) const {
  const std::optional<Sighting>& last = tools_[tool].last;
  if (!last || (last->base == ReferenceFrame::world) != head_.valid) return LeftView::no;
  Vector3 middle = last->T_base_tool * cell_.tools.items[tool].middle_m();
  if (const std::optional<Sighting>& before = tools_[tool].before) {
    const double gap_s = (last->time - before->time).seconds();
    const double ahead_s = std::min(time - last->time, k_extrapolation_max).seconds();
    const Vector3 earlier = before->T_base_tool * cell_.tools.items[tool].middle_m();
    if (gap_s > 0 && gap_s <= 2 * k_extrapolation_max.seconds()) {
      middle += (middle - earlier) * (ahead_s / gap_s);
    }
  }
  if (head_.valid) middle = head_.T_world_camera.inverse() * middle;
  const CameraModel& model = cell_.camera.model;
  const Result<Vector2> pixel = project(model, middle);
  if (!pixel) {  // behind the camera, or outside the lens
    if (std::abs(middle.x()) > std::abs(middle.y()))
      return middle.x() < 0 ? LeftView::left : LeftView::right;
    return middle.y() < 0 ? LeftView::top : LeftView::bottom;
  }
  if (pixel.value.x() < 0) return LeftView::left;
  if (pixel.value.x() > model.width) return LeftView::right;
  if (pixel.value.y() < 0) return LeftView::top;
  if (pixel.value.y() > model.height) return LeftView::bottom;
  return middle.norm() > cell_.camera.range_max_m ? LeftView::far : LeftView::no;
}

// A setting can only be the cause if the tool was never found.
void Explainer::diagnose_next_tool() {
  if (arrival_ < next_diagnosis_) return;
  const auto count = static_cast<std::size_t>(cell_.tools.count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t t = (next_tool_ + i) % count;
    ToolState& tool = tools_[t];
    if (tool.ever_measured || tool.last) continue;
    const ToolDiagnosis diagnosis = diagnose_tool(cell_, examiner_.tracker(), t);
    const auto failed = std::find_if(diagnosis.rows.begin(), diagnosis.rows.end(),
                                     [](const CheckRow& row) { return !row.passes; });
    tool.cause = *failed;
    next_tool_ = t + 1;
    next_diagnosis_ = arrival_ + k_diagnosis_period;
    return;
  }
}

void Explainer::add_output(const PoseSample& sample) noexcept {
  ToolState& tool = tools_[sample.tool];
  tool.newest = sample;
  if (!sample.has_pose()) return;
  tool.ever_measured = true;
  tool.measured = sample.measurement;
}

Explanation Explainer::explanation(std::size_t tool) const {
  const ToolState& state = tools_[tool];
  ExplainedSituation now;
  now.state = state.newest.state;
  now.reason = state.newest.reason;
  now.markers_used = std::popcount(state.newest.marker_mask);
  now.markers = cell_.tools.items[tool].marker_count;
  now.unmeasured_for = state.newest.tick - state.measured;
  now.ever_measured = state.ever_measured;
  now.any_frame = any_frame_;
  now.frame_gap = state.newest.tick - arrival_;
  // If the newest frame gave the newest measurement, only the next frame is missing.
  const bool only_next_is_missing = state.ever_measured && state.measured == arrival_ - frame_age_;
  const Duration fresh{3 * cell_.camera.period.nanoseconds / 2};
  now.frame_gap_max =
      only_next_is_missing ? fresh : std::max(k_frame_gap_max, cell_.camera.period * 3);
  now.frame_age = frame_age_;
  now.lost_after = cell_.lost_after;
  now.frame_refused = refused_;
  if (examined_ && examined_->usable) {
    now.regions = ObservedRegions{examined_->threshold, examined_->brightest,
                                  examined_->bright_share, examined_->counts, state.found};
  }
  now.left_view = state.left_view;
  now.cause = state.cause;
  now.range_min_m = cell_.camera.range_min_m;
  now.range_max_m = cell_.camera.range_max_m;
  return explain(now);
}

}  // namespace glint
