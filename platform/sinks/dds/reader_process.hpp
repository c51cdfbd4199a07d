// DDS reader as a separate process, like any other program on the network.
#pragma once

#include <optional>
#include <string>

#include "platform/sinks/dds/child_process.hpp"
#include "platform/sinks/dds/dds_settings.hpp"
#include "platform/sinks/dds/reader_result.hpp"

namespace glint {

class ReaderProcess {
 public:
  // Starts glint_dds_reader from this program's folder, with the settings' domain, interface,
  // prefix and tools. It writes result_file at the end of the stream. Throws MissingDevice if the
  // program does not exist or does not start.
  ReaderProcess(const DdsSettings& settings, const std::string& result_file);
  ~ReaderProcess();  // ends the process if it still runs
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  // Waits at most `limit` for the process to end, then terminates it, and reads its result. Throws
  // MissingDevice on failure. Call once, after the sink's stop().
  [[nodiscard]] ReaderResult finish(Duration limit);

  [[nodiscard]] pid_t id() const { return process_->id(); }

 private:
  std::string result_file_;
  std::optional<ChildProcess> process_;  // from the constructor on
};

}  // namespace glint
