// A run's messages for viewers, as an observer of the recording receives them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/message_observer.hpp"
#include "platform/sinks/record/message_parts.hpp"
#include "platform/sinks/record/topics.hpp"
#include "platform/tools/viewer/viewer_messages.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {

struct CollectedMessage {
  Time time;  // since the run's start
  std::vector<std::uint8_t> cdr;
};

class CollectedMessages : public MessageObserver {
 public:
  void add_channel(std::uint16_t channel, std::string_view topic, std::string_view type,
                   std::string_view) override {
    topics_[channel] = topic;
    types[std::string(topic)] = type;
  }
  void add_message(std::uint16_t channel, std::uint64_t unix_ns,
                   std::span<const std::uint8_t> cdr) override {
    messages[topics_.at(channel)].push_back(
        {Time{static_cast<std::int64_t>(unix_ns)}, {cdr.begin(), cdr.end()}});
  }

  std::map<std::string, std::string> types;
  std::map<std::string, std::vector<CollectedMessage>> messages;

 private:
  std::map<std::uint16_t, std::string> topics_;
};

struct ExplainedAt {
  double time_s = 0;  // of the tick, since the run's start
  std::string tool, state, reason, text;
};

// The messages of a run of `cell` on frames of `scenario`.
inline CollectedMessages collected_run(const Cell& cell, const sim::Scenario& scenario,
                                       PicturesTo pictures = PicturesTo::none) {
  const TemporaryFolder folder;
  CollectedMessages collected;
  ViewerMessages viewer(cell, pictures);
  SessionOptions options;
  options.out = folder.path();
  options.observer = &collected;
  options.derived = &viewer;
  (void)run_simulated(cell, scenario, options);
  return collected;
}

inline std::vector<ExplainedAt> explanations_of(const CollectedMessages& collected) {
  std::vector<ExplainedAt> all;
  const auto found = collected.messages.find(std::string(k_explanation_topic));
  if (found == collected.messages.end()) return all;
  // The first output is that of the first tick.
  const Time start = collected.messages.at(std::string(k_output_topic)).front().time;
  for (const CollectedMessage& message : found->second) {
    CdrReader from(message.cdr);
    skip_header(from);
    ExplainedAt one;
    one.time_s = (message.time - start).seconds();
    one.tool = from.get_text();
    one.state = from.get_text();
    one.reason = from.get_text();
    one.text = from.get_text();
    EXPECT_FALSE(from.failed());
    all.push_back(one);
  }
  return all;
}

}  // namespace glint
