#include "platform/sinks/dds/process_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "platform/input_error.hpp"

namespace glint {
namespace {

[[noreturn]] void throw_no_memory(const char* call) {
  throw MissingDevice(std::string("dds: no shared memory: ") + call + ": " + std::strerror(errno));
}

}  // namespace

SharedMemory::SharedMemory(std::size_t outgoing_bytes, std::size_t incoming_bytes)
    : descriptor_(memfd_create("glint_dds", MFD_CLOEXEC)),
      outgoing_bytes_(outgoing_bytes),
      incoming_bytes_(incoming_bytes) {
  if (descriptor_ < 0) throw_no_memory("memfd_create");
  const std::size_t size = sizeof(ProcessMemory) + outgoing_bytes + incoming_bytes;
  if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) throw_no_memory("ftruncate");
  map();
  auto* const state = new (address_) ProcessMemory;
  state->outgoing_bytes = outgoing_bytes_;
  state->incoming_bytes = incoming_bytes_;
}

SharedMemory::SharedMemory(int descriptor) : descriptor_(descriptor) {
  std::array<std::uint64_t, 2> sizes{};  // the first two fields
  if (pread(descriptor, sizes.data(), sizeof sizes, 0) != sizeof sizes) throw_no_memory("pread");
  outgoing_bytes_ = sizes[0];
  incoming_bytes_ = sizes[1];
  map();
}

SharedMemory::~SharedMemory() {
  munmap(address_, sizeof(ProcessMemory) + outgoing_bytes_ + incoming_bytes_);
  close(descriptor_);
}

void SharedMemory::map() {
  address_ = mmap(nullptr, sizeof(ProcessMemory) + outgoing_bytes_ + incoming_bytes_,
                  PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (address_ == MAP_FAILED) throw_no_memory("mmap");
}

void SharedMemory::reset() noexcept {
  ProcessMemory& all = state();
  for (RingPositions* const ring : {&all.outgoing, &all.incoming}) {
    ring->written = 0;
    ring->read = 0;
  }
  all.beat = 0;
  all.joined = 0;
  all.flushed = 0;
  all.error = {};
  for (EndpointState& endpoint : all.endpoints) {
    for (auto* const count : {&endpoint.published, &endpoint.failed, &endpoint.refused,
                              &endpoint.overwritten, &endpoint.lost}) {
      *count = 0;
    }
    for (auto* const number : {&endpoint.incompatible, &endpoint.matched, &endpoint.ready}) {
      *number = 0;
    }
  }
}

std::span<std::uint8_t> SharedMemory::outgoing() const noexcept {
  return {static_cast<std::uint8_t*>(address_) + sizeof(ProcessMemory), outgoing_bytes_};
}

std::span<std::uint8_t> SharedMemory::incoming() const noexcept {
  return {static_cast<std::uint8_t*>(address_) + sizeof(ProcessMemory) + outgoing_bytes_,
          incoming_bytes_};
}

}  // namespace glint
