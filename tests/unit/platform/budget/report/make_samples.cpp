// make_samples FOLDER: writes the sample files for checks that are shell commands.
#include <cstdio>

#include "tests/unit/platform/budget/report/sample_files.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "expected a folder\n");
    return 2;
  }
  glint::write_samples(argv[1], {});
  return 0;
}
