#include "platform/sinks/dds/reader_result.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"

namespace glint {

void save_result(const ReaderResult& result, const std::string& file) {
  const nlohmann::ordered_json json = {{"received", result.received},
                                       {"missed", result.missed},
                                       {"poses_received", result.poses_received},
                                       {"poses_announced", result.poses_expected},
                                       {"first_tick", result.first_tick},
                                       {"last_tick", result.last_tick},
                                       {"streams", result.streams},
                                       {"streams_ended", result.streams_ended},
                                       {"latency_us",
                                        {{"p50", result.latency_p50_us},
                                         {"p99", result.latency_p99_us},
                                         {"max", result.latency_max_us}}}};
  if (const std::string reason = write_file_atomically(file, json.dump(2) + "\n");
      !reason.empty()) {
    throw InputError(file + ": cannot be written: " + reason +
                     "; expected a writable folder with free space");
  }
}

ReaderResult load_result(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file + ": cannot be read; expected the DDS reader's result");
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    ReaderResult result;
    json.at("received").get_to(result.received);
    json.at("missed").get_to(result.missed);
    json.at("poses_received").get_to(result.poses_received);
    json.at("poses_announced").get_to(result.poses_expected);
    json.at("first_tick").get_to(result.first_tick);
    json.at("last_tick").get_to(result.last_tick);
    json.at("streams").get_to(result.streams);
    json.at("streams_ended").get_to(result.streams_ended);
    const nlohmann::json& latency = json.at("latency_us");
    latency.at("p50").get_to(result.latency_p50_us);
    latency.at("p99").get_to(result.latency_p99_us);
    latency.at("max").get_to(result.latency_max_us);
    return result;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": " + error.what() + "; expected the DDS reader's result");
  }
}

}  // namespace glint
