// Messages for viewers, made from those of a recording by the thread that writes it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "platform/cells/cell.hpp"
#include "platform/sinks/record/derived_messages.hpp"
#include "platform/tools/inspect/explainer.hpp"

namespace glint {

class CdrWriter;

enum class PicturesTo : std::uint8_t { none, observer, file_and_observer };

// /glint/explanation, always in the file too; and the pictures with what belongs to them.
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
  void write_explanation(const PoseSample& sample, const Explanation& explanation);

  const Cell& cell_;
  PicturesTo pictures_;
  Explainer explainer_;
  DerivedOutput* output_ = nullptr;
  Duration unix_offset_;
  std::uint16_t explanation_ = 0, picture_ = 0, camera_info_ = 0, regions_ = 0;
  std::array<Published, k_tools_max> published_;
  std::unique_ptr<CdrWriter> cdr_;
};

}  // namespace glint
