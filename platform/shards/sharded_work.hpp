// Division of a command's work into pieces, of which a shard computes every N-th.
//
// A command calls piece() for each repetition, always in the same order, and computes its figures
// from the results. Without a shard each piece is computed at once. In a shard, the pieces of other
// shards are values of zero, and the command ends at finish(). A merge runs the command again with
// the results of all shards: the same sums in the same order, so the output has equal bytes.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "platform/shards/shard_file.hpp"
#include "platform/shards/value_text.hpp"

namespace glint {

class ShardedWork {
 public:
  // command: the words after the program's name.
  explicit ShardedWork(const std::vector<std::string>& command);

  // program: this program's name, version and checksum.
  void compute_shard(const Shard& shard, const std::string& program);
  // Where finish() writes the results; default: a file named after command and shard.
  void store_in(const std::string& file) { file_ = file; }

  // Takes the results of all shards. Returns the command that computes the figures from them.
  // Throws InputError as read_all_shards() does, and for shards of another program.
  [[nodiscard]] std::vector<std::string> merge(const std::vector<std::string>& files,
                                               const std::string& program);

  // Returns the result of the next piece. compute() returns a value for value_text.hpp, which may
  // not depend on other pieces.
  template <class Compute>
  [[nodiscard]] std::invoke_result_t<const Compute&> piece(const Compute& compute) {
    const int index = pieces_++;
    if (mode_ == Mode::whole) return compute();
    std::invoke_result_t<const Compute&> result{};
    if (mode_ == Mode::merge) {
      const PieceResult& stored = stored_result(index);
      ValueReader reader(stored.text, "piece " + std::to_string(index));
      reader.read(result);
      reader.end();
    } else if (is_own(index)) {
      result = compute();
      own_.results.push_back({index, {}});
      append_value(result, own_.results.back().text);
    }
    return result;
  }

  [[nodiscard]] bool is_shard() const { return mode_ == Mode::shard; }

  // Whether compute() is called for the piece that follows `ahead` others.
  [[nodiscard]] bool computes(int ahead) const {
    return mode_ == Mode::whole || (mode_ == Mode::shard && is_own(pieces_ + ahead));
  }

  // Call after the last piece. Returns true in a shard, whose results it has written: the command
  // ends. Throws InputError if the file cannot be written, or if a merge had other pieces.
  [[nodiscard]] bool finish();

 private:
  enum class Mode { whole, shard, merge };

  [[nodiscard]] bool is_own(int piece) const {
    return piece % own_.shard.count == own_.shard.number - 1;
  }
  [[nodiscard]] const PieceResult& stored_result(int piece) const;

  Mode mode_ = Mode::whole;
  ShardFile own_;
  std::string file_;
  std::vector<ShardFile> merged_;
  int pieces_ = 0;
};

// A command's access to its work. Without work each piece is computed at once.
struct Pieces {
  ShardedWork* work = nullptr;

  [[nodiscard]] bool computes(int ahead) const { return work == nullptr || work->computes(ahead); }

  template <class Compute>
  [[nodiscard]] std::invoke_result_t<const Compute&> operator()(const Compute& compute) const {
    return work == nullptr ? compute() : work->piece(compute);
  }
};

}  // namespace glint
