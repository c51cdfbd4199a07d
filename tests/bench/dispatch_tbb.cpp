#include "dispatch_tbb.hpp"

#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <functional>

#include "dispatch_nodes.hpp"

namespace glint::bench {
namespace {

namespace flow = oneapi::tbb::flow;

struct Message {
  int b = 0;
  int value = 0;
};

// The bodies of MakeB to MakeE; a chain of one-input nodes passes `b` on for MakeD.
template <class Policy>
struct FlowChain {
  explicit FlowChain(flow::graph& graph)
      : make_b(graph, flow::serial,
               [](int a) {
                 return Message{a + 1, a + 1};
               }),
        make_c(graph, flow::serial,
               [](Message m) {
                 return Message{m.b, m.b ^ 2};
               }),
        make_d(graph, flow::serial,
               [](Message m) {
                 return Message{m.b, m.b + m.value};
               }),
        make_e(graph, flow::serial, [this](Message m) { return last += m.value; }) {
    flow::make_edge(make_b, make_c);
    flow::make_edge(make_c, make_d);
    flow::make_edge(make_d, make_e);
  }

  int last = 0;
  flow::function_node<int, Message, Policy> make_b;
  flow::function_node<Message, Message, Policy> make_c;
  flow::function_node<Message, Message, Policy> make_d;
  flow::function_node<Message, int, Policy> make_e;
};

}  // namespace

struct TbbFlow::Nodes {
  explicit Nodes(TbbPolicy policy) {
    arena.execute([&] {
      graph = std::make_unique<flow::graph>();
      if (policy == TbbPolicy::spawned) {
        spawned = std::make_unique<FlowChain<flow::queueing>>(*graph);
      } else {
        lightweight = std::make_unique<FlowChain<flow::queueing_lightweight>>(*graph);
      }
    });
  }

  template <class Chain>
  int run(Chain& chain, int count) {
    arena.execute([&] {
      for (int i = 0; i < count; ++i) {
        chain.make_b.try_put(i);
        graph->wait_for_all();
      }
    });
    return chain.last;
  }

  oneapi::tbb::global_control one_thread{oneapi::tbb::global_control::max_allowed_parallelism, 1};
  oneapi::tbb::task_arena arena{1};
  std::unique_ptr<flow::graph> graph;
  std::unique_ptr<FlowChain<flow::queueing>> spawned;
  std::unique_ptr<FlowChain<flow::queueing_lightweight>> lightweight;
};

TbbFlow::TbbFlow(TbbPolicy policy) : nodes_(std::make_unique<Nodes>(policy)) {}
TbbFlow::~TbbFlow() = default;

int TbbFlow::run(int count) {
  return nodes_->spawned != nullptr ? nodes_->run(*nodes_->spawned, count)
                                    : nodes_->run(*nodes_->lightweight, count);
}

}  // namespace glint::bench
