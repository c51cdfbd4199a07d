// glint COMMAND: frames in, poses out, and what they are worth.
#include <cstdio>
#include <exception>

#include "platform/cli/commands.hpp"
#include "platform/input_error.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Glint: the pose of a pen with reflective markers, from a headset's camera"};
  app.require_subcommand(1);
  app.footer("Example: glint run --out out --json out/summary.json");
  int exit_code = 0;
  glint::add_run(app, exit_code);
  glint::add_replay(app, exit_code);
  glint::add_simulate(app, exit_code);
  glint::add_experiment(app, exit_code);
  glint::add_calibrate(app, exit_code);
  glint::add_map(app, exit_code);
  glint::add_reference(app, exit_code);
  glint::add_path(app, exit_code);
  glint::add_inspect(app, exit_code);
  glint::add_budget(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help asked for is success; anything else is bad use, whatever CLI11 numbers it.
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const glint::InputError& error) {
    std::fprintf(stderr, "glint: %s\n", error.what());
    return 2;
  } catch (const glint::MissingDevice& error) {
    std::fprintf(stderr, "glint: %s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "glint: %s\n", error.what());
    return 1;
  }
  return exit_code;
}
