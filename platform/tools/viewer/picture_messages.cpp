#include "platform/tools/viewer/picture_messages.hpp"

#include <cstring>
#include <vector>

#include "platform/sinks/record/ros_messages.hpp"

namespace glint {
namespace {

// glint_msgs/PixelRectangle without pixels.
void put_box(CdrWriter& to, const Roi& box) {
  to.put(static_cast<std::uint16_t>(box.x0));
  to.put(static_cast<std::uint16_t>(box.y0));
  to.put(static_cast<std::uint16_t>(box.x1 - box.x0));
  to.put(static_cast<std::uint16_t>(box.y1 - box.y0));
  to.put_length(0);
  to.put_length(0);
}

}  // namespace

void write_picture(CdrWriter& to, Time stamp, const Frame& frame) {
  const auto count =
      static_cast<std::size_t>(frame.width()) * static_cast<std::size_t>(frame.height());
  std::vector<std::uint16_t> pixels(count);
  if (frame.reflectivity_8.empty()) {
    std::memcpy(pixels.data(), frame.reflectivity_16.pixels, count * sizeof pixels[0]);
  } else {
    for (std::size_t i = 0; i < count; ++i) pixels[i] = frame.reflectivity_8.pixels[i];
  }
  const ImageShape shape{static_cast<std::uint32_t>(frame.width()),
                         static_cast<std::uint32_t>(frame.height()), 2, "mono16"};
  write_image(to, stamp, shape, {reinterpret_cast<const std::uint8_t*>(pixels.data()), 2 * count});
}

void write_camera_info(CdrWriter& to, Time stamp, const CameraModel& model) {
  to.begin();
  put_header(to, stamp, k_camera_frame);
  to.put(static_cast<std::uint32_t>(model.height));
  to.put(static_cast<std::uint32_t>(model.width));
  const std::size_t coefficients = model.lens == Lens::pinhole ? 0
                                   : model.lens == Lens::brown ? 5
                                                               : model.distortion.size();
  to.put(coefficients == 8 ? "rational_polynomial" : "plumb_bob");
  to.put_length(coefficients);
  for (std::size_t i = 0; i < coefficients; ++i) to.put(model.distortion[i]);
  for (const double k : {model.fx, 0.0, model.cx, 0.0, model.fy, model.cy, 0.0, 0.0, 1.0}) {
    to.put(k);
  }
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) to.put(r);
  for (const double p :
       {model.fx, 0.0, model.cx, 0.0, 0.0, model.fy, model.cy, 0.0, 0.0, 0.0, 1.0, 0.0}) {
    to.put(p);
  }
  to.put(std::uint32_t{0});  // binning
  to.put(std::uint32_t{0});
  for (int i = 0; i < 4; ++i) to.put(std::uint32_t{0});  // the whole picture
  to.put(false);
}

void write_regions(CdrWriter& to, Time stamp, std::span<const Roi> searched,
                   const ExaminedFrame& examined) {
  to.begin();
  put_header(to, stamp, k_camera_frame);
  to.put(std::uint32_t{examined.threshold});
  to.put_length(searched.size());
  for (const Roi& roi : searched) put_box(to, roi);
  to.put_length(examined.regions.size());
  for (const ExaminedRegion& region : examined.regions) {
    to.put(static_cast<float>(region.centroid_px.x()));
    to.put(static_cast<float>(region.centroid_px.y()));
    to.put(region.area_px);
    to.put(std::uint32_t{region.peak});
    put_box(to, region.box);
    to.put(region.reason);
    to.put(region.marker);
    to.put(static_cast<float>(region.range_m));
  }
}

}  // namespace glint
