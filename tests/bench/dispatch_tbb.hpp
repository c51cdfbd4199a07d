// The same four nodes as a oneTBB flow graph, on one thread.
#pragma once

#include <memory>

namespace glint::bench {

// `spawned`: every node is a task, the library's default. `lightweight`: the policy for short
// bodies, which runs a node in the sender's task.
enum class TbbPolicy { spawned, lightweight };

class TbbFlow {
 public:
  explicit TbbFlow(TbbPolicy policy);
  ~TbbFlow();

  // Sends `count` messages, each after the arrival of the previous one, and returns the last
  // result.
  int run(int count);

 private:
  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace glint::bench
