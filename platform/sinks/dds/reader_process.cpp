#include "platform/sinks/dds/reader_process.hpp"

#include <csignal>
#include <cstdio>
#include <vector>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr Duration k_end_limit = milliseconds(5000);  // from SIGTERM to the end of the process

std::vector<std::string> arguments_of(const DdsSettings& settings, const std::string& file) {
  std::vector<std::string> arguments = {"glint_dds_reader",
                                        "--interface",
                                        settings.interface,
                                        "--domain",
                                        std::to_string(settings.domain),
                                        "--prefix",
                                        settings.topic_prefix,
                                        "--out",
                                        file};
  for (const std::string& tool : settings.tool_names) {
    arguments.insert(arguments.end(), {"--tool", tool});
  }
  for (const std::string& peer : settings.peers) {
    arguments.insert(arguments.end(), {"--peer", peer});
  }
  if (!settings.name.empty()) arguments.insert(arguments.end(), {"--name", settings.name});
  if (!settings.security.empty()) {
    arguments.insert(arguments.end(), {"--security", settings.security});
  }
  return arguments;
}

}  // namespace

ReaderProcess::ReaderProcess(const DdsSettings& settings, const std::string& result_file)
    : result_file_(result_file) {
  std::remove(result_file.c_str());  // removes the result of an earlier run
  process_.emplace(arguments_of(settings, result_file));
}

ReaderProcess::~ReaderProcess() {
  process_->send(SIGTERM);
  (void)process_->wait(k_end_limit);
}

ReaderResult ReaderProcess::finish(Duration limit) {
  if (!process_->wait(limit)) {
    process_->send(SIGTERM);
    if (!process_->wait(k_end_limit)) {
      throw MissingDevice("dds: the reader process does not end");
    }
  }
  if (!process_->succeeded()) {
    throw MissingDevice("dds: the reader process " + process_->how_it_ended() +
                        "; expected its result in " + result_file_);
  }
  return load_result(result_file_);
}

}  // namespace glint
