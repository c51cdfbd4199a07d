#include "platform/apps/glint/shard_option.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

#include "platform/apps/glint/lab_program.hpp"
#include "platform/apps/version/version.hpp"
#include "platform/shards/shard_file.hpp"
#include "platform/sinks/record/crc32.hpp"

namespace glint {
namespace {

constexpr const char* k_lab = "glint_lab ";

// The checksum of the program's file: two builds of one commit may differ.
std::string program_text() {
  const std::string own = "/proc/self/exe";
  std::ifstream file(own, std::ios::binary);
  std::array<char, 1 << 16> part;
  std::uint32_t sum = 0;
  while (file.read(part.data(), part.size()), file.gcount() > 0) {
    sum = crc32(sum, {reinterpret_cast<const std::uint8_t*>(part.data()),
                      static_cast<std::size_t>(file.gcount())});
  }
  std::array<char, 16> digits;
  std::snprintf(digits.data(), digits.size(), "%08x", sum);
  const std::string name = std::filesystem::read_symlink(own).filename().string();
  return name + " of " + version_text() + ", sum " + digits.data();
}

// Returns the error text of CLI11, or "".
std::string parse_shard(const std::string& text, Shard& shard) {
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  if (number.ec == std::errc{} && number.ptr != end && *number.ptr == '/') {
    const auto count = std::from_chars(number.ptr + 1, end, shard.count);
    if (count.ec == std::errc{} && count.ptr == end && shard.number >= 1 &&
        shard.number <= shard.count && shard.count <= k_shards_max) {
      return "";
    }
  }
  return text + ": expected i/N, 1 <= i <= N <= " + std::to_string(k_shards_max);
}

}  // namespace

void add_shard_option(CLI::App& command, ShardedWork& work) {
  const auto compute_shard = [&work](const std::string& text) {
    Shard shard;
    (void)parse_shard(text, shard);
    work.compute_shard(shard, program_text());
  };
  command
      .add_option_function<std::string>(
          "--shard", compute_shard,
          "i/N: computes every N-th piece of the work, from the i-th on, and stores the raw "
          "results; `glint merge` ends the command")
      ->check([](const std::string& text) {
        Shard ignored;
        return parse_shard(text, ignored);
      });
  command.add_option_function<std::string>(
      "--shard-file", [&work](const std::string& file) { work.store_in(file); },
      "file of a shard's results; default: named after command and shard");
}

void add_merge(CLI::App& app, ShardedWork& work, std::vector<std::string>& merged) {
  CLI::App* command =
      app.add_subcommand("merge", "End a command whose work was divided by --shard");
  const auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("FILES", *files, "files of all shards, in any order")->required();
  command->footer(
      "Example: glint merge experiment_noise.*.shard\n"
      "Output, files and exit code are those of the command without --shard, byte for byte.\n"
      "Its relative paths start at this folder.");
  command->callback([files, &work, &merged] {
    const std::string program = program_text();
    if (read_shard_file(files->front()).program.starts_with(k_lab) && !program.starts_with(k_lab))
      start_lab();
    merged = work.merge(*files, program);
  });
}

void parse_command(CLI::App& app, int argc, char** argv, const std::vector<std::string>& merged) {
  app.parse(argc, argv);
  if (merged.empty()) return;
  std::vector<std::string> words(merged.rbegin(), merged.rend());  // the order that CLI11 takes
  app.parse(std::move(words));
}

}  // namespace glint
