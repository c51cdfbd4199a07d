// The reader as a process of its own, as any other program on the network would be.
#pragma once

#include <sys/types.h>

#include <string>

#include "platform/dds/dds_settings.hpp"
#include "platform/dds/reader_result.hpp"

namespace glint {

class ReaderProcess {
 public:
  // Starts glint_dds_reader, which lies beside this program, on the settings' domain, interface,
  // prefix and tools; it writes result_file when the stream ends. Throws MissingDevice when the
  // program is not there or does not start.
  ReaderProcess(const DdsSettings& settings, const std::string& result_file);
  ~ReaderProcess();  // ends it, if it has not ended
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  // Waits until it ends by itself, after `limit` tells it to, and reads its result. Throws
  // MissingDevice when it failed. Call it once, after the sink's stop().
  [[nodiscard]] ReaderResult finish(Duration limit);

  [[nodiscard]] pid_t id() const { return id_; }

 private:
  // Whether it has ended within the limit.
  bool wait(Duration limit);

  std::string result_file_;
  pid_t id_ = -1;
  int status_ = 0;
};

}  // namespace glint
