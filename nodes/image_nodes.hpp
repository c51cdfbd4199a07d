// Image-processing nodes: thresholding by bands of rows, connected components, marker candidates.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "kernels/pose/back_project.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// One of the graph's k_row_bands bands of rows.
struct RoiThreshold {
  std::uint16_t threshold = 0;
  Limits limits;
  void operator()(const Frame& frame, const Rois& rois, graph::Partition band,
                  Runs& runs) noexcept {
    work_ = threshold_runs(frame, rois, threshold, {band.index, band.count}, runs, limits);
  }

  static constexpr std::array<std::string_view, 4> k_loops = {"call", "stretches", "blocks",
                                                              "runs"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return counts_of(threshold_work_max(limits, k_row_bands));
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_of(work_); }

 private:
  static constexpr graph::LoopCounts counts_of(const ThresholdWork& work) noexcept {
    return {{1, work.stretches, work.blocks, work.runs}};
  }
  ThresholdWork work_;
};
static_assert(graph::Budgeted<RoiThreshold, Limits>);

// Connected components of the bands' runs, joined in band order.
struct FindBlobs {
  BlobSettings settings;
  Limits limits;
  void operator()(const Frame& frame, const graph::Parts<Runs, k_row_bands>& bands,
                  const Predictions& predictions, Blobs& blobs) noexcept {
    std::array<const Runs*, k_row_bands> in_order;
    for (int i = 0; i < k_row_bands; ++i) in_order[static_cast<std::size_t>(i)] = &bands[i];
    const std::span predicted(predictions.markers_px.data(),
                              static_cast<std::size_t>(predictions.marker_count));
    work_ = find_blobs(frame, in_order, settings,
                       {predicted, predictions.search_whole_frame, predictions.frame_number},
                       scratch_, blobs, limits);
  }

  static constexpr std::array<std::string_view, 6> k_loops = {"call",  "runs",   "distances",
                                                              "blobs", "pixels", "rescans"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return counts_of(blob_work_max(limits));
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_of(work_); }

 private:
  static constexpr graph::LoopCounts counts_of(const BlobWork& work) noexcept {
    return {{1, work.runs, work.distances, work.blobs, work.pixels, work.rescans}};
  }
  BlobScratch scratch_;
  BlobWork work_;
};
static_assert(graph::Budgeted<FindBlobs, Limits>);

// Ray and range of each blob. Blobs without depth are kept: they are reported but never labelled.
struct BackProject {
  CameraModel camera;
  DepthSettings depth;
  NominalMarker nominal;
  Limits limits;
  // Computes the lens's effect on a sphere's image. Call after `camera` is set.
  [[nodiscard]] Reason prepare() noexcept {
    sphere_offset_ = sphere_offset(camera);
    return Reason::none;
  }
  void operator()(const Frame& frame, const Blobs& blobs, Markers& markers) noexcept {
    work_ = back_project(frame, blobs, camera, sphere_offset_, depth, nominal, markers, limits);
  }

  static constexpr std::array<std::string_view, 6> k_loops = {"call",   "blobs",   "lens_steps",
                                                              "pixels", "samples", "unwrapped"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return counts_of(back_project_work_max(limits));
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_of(work_); }

 private:
  static constexpr graph::LoopCounts counts_of(const BackProjectWork& work) noexcept {
    return {{1, work.blobs, work.lens_steps, work.pixels, work.samples, work.unwrapped}};
  }
  SphereOffset sphere_offset_;
  BackProjectWork work_;
};
static_assert(graph::Budgeted<BackProject, Limits>);

}  // namespace glint
