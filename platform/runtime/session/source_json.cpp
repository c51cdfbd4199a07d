#include "platform/runtime/session/source_json.hpp"

#include <nlohmann/json.hpp>

namespace glint {

nlohmann::ordered_json as_json(const SourceReport& report) {
  using Json = nlohmann::ordered_json;
  Json counts = Json::object(), events = Json::array();
  for (const auto& [name, count] : report.counts) counts[name] = count;
  for (const SourceReport::Event& event : report.events) {
    events.push_back({{"fault", event.fault},
                      {"time_s", (event.time - Time{}).seconds()},
                      {"after_frames", event.frames}});
  }
  return {
      {"text", report.text}, {"counts", counts}, {"failures", report.failures}, {"events", events}};
}

}  // namespace glint
