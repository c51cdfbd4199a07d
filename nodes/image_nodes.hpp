// The nodes that touch pixels: bright runs by bands of rows, blobs, candidate markers.
#pragma once

#include <array>

#include "graph/graph.hpp"
#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "kernels/pose/back_project.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// One band of rows; the graph has k_row_bands of them.
struct RoiThreshold {
  std::uint16_t threshold = 0;
  void operator()(const Frame& frame, const Rois& rois, graph::Slice band,
                  Runs& runs) const noexcept {
    threshold_runs(frame, rois, threshold, RowBand{band.index, band.count}, runs);
  }
};

// Joins the bands' runs in band order.
struct FindBlobs {
  BlobSettings settings;
  void operator()(const Frame& frame, const graph::Parts<Runs, k_row_bands>& bands,
                  const Predictions& predictions, Blobs& blobs) noexcept {
    std::array<const Runs*, k_row_bands> in_order;
    for (int i = 0; i < k_row_bands; ++i) in_order[static_cast<std::size_t>(i)] = &bands[i];
    const std::span predicted(predictions.markers_px.data(),
                              static_cast<std::size_t>(predictions.marker_count));
    find_blobs(frame, in_order, settings, predicted, scratch_, blobs);
  }

 private:
  BlobScratch scratch_;
};

// Each blob's ray and range. Blobs without depth are kept: they are reported, never labelled.
struct BackProject {
  CameraModel camera;
  DepthSettings depth;
  NominalMarker nominal;
  void operator()(const Frame& frame, const Blobs& blobs, Markers& markers) const noexcept {
    markers.count = 0;
    for (int i = 0; i < blobs.count; ++i) {
      Marker& marker = markers.items[static_cast<std::size_t>(markers.count)];
      if (measure_marker(frame, blobs.items[static_cast<std::size_t>(i)],
                         static_cast<std::uint16_t>(i), camera, depth, nominal, marker)) {
        ++markers.count;
      }
    }
  }
};

}  // namespace glint
