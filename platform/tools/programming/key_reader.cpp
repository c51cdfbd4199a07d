#include "platform/tools/programming/key_reader.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <utility>

namespace glint {
namespace {

constexpr std::chrono::milliseconds k_poll_period{20};
constexpr std::size_t k_keys_max = 64;  // per wake-up

}  // namespace

KeyReader::KeyReader(int descriptor, std::function<Time()> now, KeyButtons::OnButton on_button)
    : descriptor_(descriptor), now_(std::move(now)), buttons_(std::move(on_button)) {
  thread_ = std::thread([this] {
    while (!stopping_) read_once();
  });
  pthread_setname_np(thread_.native_handle(), "glint_keys");
}

KeyReader::~KeyReader() {
  stopping_ = true;
  thread_.join();
}

void KeyReader::read_once() {
  pollfd waiting{descriptor_, POLLIN, 0};
  if (::poll(&waiting, 1, static_cast<int>(k_poll_period.count())) <= 0) return;
  std::array<char, k_keys_max> keys{};
  const ssize_t count = ::read(descriptor_, keys.data(), keys.size());
  // poll() always reports a closed terminal as ready, without data.
  if (count <= 0) {
    std::this_thread::sleep_for(k_poll_period);
    return;
  }
  const Time time = now_();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) buttons_.press(keys[i], time);
}

}  // namespace glint
