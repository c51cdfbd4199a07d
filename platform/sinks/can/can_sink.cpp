#include "platform/sinks/can/can_sink.hpp"

#include "platform/input_error.hpp"
#include "platform/sinks/can/log_sink.hpp"
#include "platform/sinks/can/socketcan_sink.hpp"

namespace glint {

std::unique_ptr<CanSink> open_can_sink(const std::string& specification,
                                       const CanSinkOptions& options) {
  const auto colon = specification.find(':');
  const std::string kind = specification.substr(0, colon);
  const std::string target = colon == std::string::npos ? "" : specification.substr(colon + 1);
  if (kind == "socketcan" && !target.empty()) return open_socketcan_sink(target, options);
  if (kind == "log" && !target.empty()) return open_log_sink(target, options);
  throw InputError("CAN sink: found \"" + specification +
                   "\"; expected \"socketcan:IF\" or \"log:FILE\"");
}

}  // namespace glint
