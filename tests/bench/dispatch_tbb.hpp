// The rival: the same four nodes as a oneTBB flow graph, on one thread like ours.
#pragma once

#include <memory>

namespace glint::bench {

// `spawned`: every node is a task, the library's default. `lightweight`: its policy for tiny
// bodies, which runs a node in the place of its sender.
enum class TbbPolicy { spawned, lightweight };

class TbbFlow {
 public:
  explicit TbbFlow(TbbPolicy policy);
  ~TbbFlow();

  // Sends `count` messages through, each after the one before has arrived, and returns the last
  // result.
  int run(int count);

 private:
  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace glint::bench
