// glint_dds_participant: the DDS participant of a program, in a process of its own. The program
// starts it with the memory that both share as descriptor 3, and restarts it when it ends.
//   glint_dds_participant --interface lo --domain 0
// Exit codes: 0 ended by the program, 1 fault, 2 wrong usage, 3 no network interface.
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <string>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/served_endpoints.hpp"

namespace {

constexpr glint::Duration k_wait = glint::milliseconds(20);
constexpr rlim_t k_memory_max = rlim_t{1} << 30;
// Below the program: a flood of packets takes no processor time from its threads.
constexpr int k_nice = 5;

void limit_resources() {
  const rlimit no_core{0, 0}, memory{k_memory_max, k_memory_max};
  setrlimit(RLIMIT_CORE, &no_core);
#ifndef GLINT_SANITIZED
  setrlimit(RLIMIT_DATA, &memory);
#else
  (void)memory;
#endif
  setpriority(PRIO_PROCESS, 0, k_nice);
}

// The program's end changes the parent.
void serve(glint::ServedEndpoints& endpoints, pid_t program) {
  while (!endpoints.ended() && getppid() == program) {
    const std::uint32_t seen = endpoints.signals();
    const bool any = endpoints.work();
    endpoints.update_states();
    if (!any) endpoints.wait(seen, k_wait);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const pid_t program = getppid();
  glint::DdsSettings settings;
  CLI::App app{
      "DDS participant of a Glint program, which starts it.\n"
      "Example: glint_dds_participant --interface lo --domain 0"};
  app.add_option("--interface", settings.interface, "network interface")->capture_default_str();
  app.add_option("--domain", settings.domain, "DDS domain, ROS_DOMAIN_ID")->capture_default_str();
  app.add_option("--peer", settings.peers, "address for discovery; repeatable");
  app.add_option("--name", settings.name, "namespace of the node; default: none");
  app.add_option("--ros-graph", settings.ros_graph, "release of ROS 2 that shows the node");
  app.add_option("--security", settings.security, "folder with keys and documents");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  limit_resources();
  try {
    glint::SharedMemory memory(glint::k_memory_descriptor);
    try {
      glint::ServedEndpoints endpoints(settings, memory);
      memory.state().joined = 1;
      serve(endpoints, program);
      return 0;
    } catch (const glint::InputError& error) {
      const std::string text = error.what();
      text.copy(memory.state().error.data(), memory.state().error.size() - 1);
      return 2;
    }
  } catch (const glint::MissingDevice& error) {
    std::cerr << error.what() << '\n';
    return 3;
  } catch (const std::exception& error) {
    std::cerr << "glint_dds_participant: " << error.what() << '\n';
    return 1;
  }
}
