// Messages for viewers, made from those of a recording by the thread that writes it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "platform/cells/cell.hpp"
#include "platform/sinks/record/derived_messages.hpp"
#include "platform/tools/inspect/explainer.hpp"

namespace glint {

class CdrWriter;
class SceneMessages;

enum class PicturesTo : std::uint8_t { none, observer, file_and_observer };

// /glint/explanation, always in the file too; and with `pictures` those, their regions, the scene,
// the transforms of headset and robot, and the robot's description.
class ViewerMessages : public DerivedMessages {
 public:
  // The cell outlives it.
  ViewerMessages(const Cell& cell, PicturesTo pictures);
  ~ViewerMessages() override;

  void open(DerivedOutput& output, Duration unix_offset) override;
  void add(const FramePatch& patch) override;
  void add(const HeadPose& head) override;
  void add(const DroppedInput& input) override;
  void add(const RobotFrameRecord& robot) override;
  void add(const ButtonEvent& event) override;
  void add(const PoseSample& sample) override;

 private:
  struct Published {
    Explanation explanation;
    Time decided, written;
    bool any = false;
  };
  void write_pictures(const FramePatch& patch, const Frame& frame, const ExaminedFrame& examined);
  void write_transform_from_world(std::string_view child, const Pose& pose, Time time);
  void write_scene(Time time);
  void write_robot(Time time);
  void write_explanation(const PoseSample& sample, const Explanation& explanation);

  const Cell& cell_;
  PicturesTo pictures_;
  Explainer explainer_;
  DerivedOutput* output_ = nullptr;
  Duration unix_offset_;
  std::uint16_t explanation_ = 0, picture_ = 0, camera_info_ = 0, regions_ = 0, scene_ = 0,
                transform_ = 0, robot_description_ = 0;
  std::array<Published, k_tools_max> published_;
  std::unique_ptr<SceneMessages> scene_shapes_;
  Time next_scene_, next_robot_;
  std::optional<Pose> T_world_robot_;
  std::string urdf_;
  std::unique_ptr<CdrWriter> cdr_;
};

}  // namespace glint
