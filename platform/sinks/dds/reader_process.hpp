// DDS reader as a separate process, like any other program on the network.
#pragma once

#include <sys/types.h>

#include <string>

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

  [[nodiscard]] pid_t id() const { return id_; }

 private:
  // Returns whether the process ended within the limit.
  bool wait(Duration limit);

  std::string result_file_;
  pid_t id_ = -1;
  int status_ = 0;
};

}  // namespace glint
