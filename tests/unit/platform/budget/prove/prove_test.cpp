// Bounds of small functions with known longest paths, in this program's own machine code.
#include "platform/budget/prove/prove.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "platform/budget/prove/proved_code.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/beside_test.hpp"
#include "tests/unit/platform/budget/prove/observed_steps.hpp"
#include "tests/unit/platform/budget/prove/toy_code.hpp"

namespace glint::prove {
namespace {

constexpr int k_values = 40;
using Values = std::array<int, 64>;

std::string source_folder() { return path_beside_test("source_tree"); }
std::string toy_file(const std::string& name) {
  return source_folder() + "/tests/unit/platform/budget/prove/" + name;
}

class ProveToy : public testing::Test {
 protected:
  ProveToy() {
    folder_ = std::filesystem::temp_directory_path() /
              ("glint_prove_" + std::to_string(getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  ~ProveToy() override { std::filesystem::remove_all(folder_); }

  KernelProof proof_of(const std::string& kernel) const {
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    const LoopBounds bounds(toy_file("toy_loops.toml"), source_folder());
    return Prover(program, program, bounds, {{"values", k_values}})
        .prove({kernel, {{"values", k_values}}}, folder_.string());
  }

  // Number of the pairs that the checker accepts.
  struct Pair {
    std::string graph, certificate;
  };
  int accepted(const std::vector<Pair>& pairs) const {
    std::string command = "'" + toy_file("check_certificate") + "'";
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::filesystem::path folder = folder_ / std::to_string(i);
      std::filesystem::create_directories(folder);
      std::ofstream(folder / "path.graph") << pairs[i].graph;
      std::ofstream(folder / "path.certificate") << pairs[i].certificate;
      command += " '" + folder.string() + "'";
    }
    const std::filesystem::path verdicts = folder_ / "verdicts.txt";
    command += " > '" + verdicts.string() + "'";
    const bool all = std::system(command.c_str()) == 0;
    int count = 0, lines = 0;
    std::ifstream file(verdicts);
    for (std::string line; std::getline(file, line); ++lines) {
      if (line.starts_with("accepted: ")) ++count;
    }
    EXPECT_EQ(lines, static_cast<int>(pairs.size()));
    EXPECT_EQ(all, count == lines);
    return count;
  }

  void expect_reason(const std::string& kernel, const std::string& reason) const {
    const KernelProof proof = proof_of(kernel);
    EXPECT_FALSE(proof.proved());
    const auto is_it = [&](const std::string& one) { return one.find(reason) != one.npos; };
    EXPECT_TRUE(std::any_of(proof.reasons.begin(), proof.reasons.end(), is_it))
        << kernel << ": " << (proof.reasons.empty() ? "proved" : proof.reasons.front());
  }

  std::filesystem::path folder_;
};

// Largest observed count over inputs that drive every loop to its maximum, and over others.
std::int64_t most_steps(ToyFunction function) {
  std::int64_t most = -1;
  for (const int step : {0, 1, 2, 3, 7}) {
    Values values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = step == 0 || static_cast<int>(i) % step != 0 ? 1 : 0;
    }
    for (const int count : {0, 1, 17, k_values}) {
      most = std::max(most, observed_steps(function, values.data(), count));
    }
  }
  return most;
}

void expect_tight(const KernelProof& proof, ToyFunction function, std::int64_t loose) {
  ASSERT_TRUE(proof.proved()) << proof.reasons.front();
  EXPECT_TRUE(proof.tight);
  const std::int64_t observed = most_steps(function);
  if (observed < 0) GTEST_SKIP() << "this system refuses single steps";
  EXPECT_GE(proof.certificate.bound, observed);
  EXPECT_LE(proof.certificate.bound, observed + loose);
}

TEST_F(ProveToy, BoundsALoopByItsDeclaredMaximum) {
  expect_tight(proof_of("Sum"), &toy_sum, 8);  // one pass more: the maximum is of jumps back
}

TEST_F(ProveToy, AddsEachCall) { expect_tight(proof_of("Calls"), &toy_calls, 16); }

TEST_F(ProveToy, CountsALoopOfConstantsExactly) {
  const KernelProof proof = proof_of("Counted");
  expect_tight(proof, &toy_counted, 0);
  std::vector<std::int64_t> jumps_back;
  for (const PathLoop& loop : proof.graph.loops) jumps_back.push_back(loop.at_most);
  std::sort(jumps_back.begin(), jumps_back.end());
  EXPECT_EQ(jumps_back, (std::vector<std::int64_t>{11, 12}));
  expect_reason("Uneven", "a loop without a maximum at toy_uneven+0x");
}

TEST_F(ProveToy, BoundsACycleWithTwoEntries) {
  const KernelProof proof = proof_of("TwoEntries");
  expect_tight(proof, &toy_two_entries, 8);
  EXPECT_EQ(accepted({{proof.graph_text, proof.certificate_text}}), 1);
}

TEST_F(ProveToy, SharesATotalAmongAllRunsOfALoop) {
  const KernelProof proof = proof_of("Stretches");
  ASSERT_TRUE(proof.proved()) << proof.reasons.front();
  EXPECT_EQ(proof.graph.totals.size(), 1u);
  const std::int64_t observed = most_steps(&toy_stretches);
  if (observed < 0) GTEST_SKIP() << "this system refuses single steps";
  EXPECT_GE(proof.certificate.bound, observed);
  // Without the total the inner loop would run in each of the 40 passes of the outer one.
  EXPECT_LE(proof.certificate.bound, 40 * 40 * 4);
}

TEST_F(ProveToy, CoversABranchThatNoInputEnteredAndNamesItsBlocks) {
  const KernelProof proof = proof_of("Rare");
  ASSERT_TRUE(proof.proved()) << proof.reasons.front();
  ASSERT_FALSE(proof.heaviest.empty());
  EXPECT_EQ(proof.heaviest.front().place.find("tests/unit/platform/budget/prove/toy_code.cpp:"),
            0u);
  Values values{};
  const std::int64_t usual = most_steps(&toy_rare);
  values.fill(1);
  values[0] = 123456789;
  const std::int64_t rare = observed_steps(&toy_rare, values.data(), k_values);
  if (rare < 0) GTEST_SKIP() << "this system refuses single steps";
  EXPECT_GT(rare, 10 * usual);
  EXPECT_GE(proof.certificate.bound, rare);
}

TEST_F(ProveToy, RefusesByNameWhatHasNoBound) {
  expect_reason("UnknownLoop", "a loop without a maximum at toy_unknown_loop+0x");
  expect_reason("Recursion", "recursion into toy_recursion");
  expect_reason("IndirectCall", "an indirect call: ");
  expect_reason("Copy", "a call of memcpy with a computed size at toy_copy+0x");
  expect_reason("Missing", "no function of the program starts with toy_missing");
  expect_reason("Undeclared", "no function is declared for this kernel");
}

TEST_F(ProveToy, RefusesASwitchTableByName) {
  expect_reason("Switch", "an indirect jump (switch table): ");
}

TEST_F(ProveToy, NamesTheSourceLineOfARefusal) { expect_reason("UnknownLoop", "toy_code.cpp:46)"); }

TEST_F(ProveToy, RejectsALoopWhoseLineMoved) {
  std::ifstream file(toy_file("toy_loops.toml"));
  std::stringstream text;
  text << file.rdbuf();
  std::string moved = text.str();
  moved.replace(moved.find("\"11-14\""), 7, "\"12-15\"");
  std::ofstream(folder_ / "moved.toml") << moved;
  try {
    (void)LoopBounds((folder_ / "moved.toml").string(), source_folder());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("; line 11 has it"), std::string::npos)
        << error.what();
  }
}

TEST_F(ProveToy, BoundsATriangularLoopByItsSum) {
  const KernelProof proof = proof_of("Triangle");
  expect_tight(proof, &toy_triangle, 700);  // twice as many with the inner loop's maximum alone
  EXPECT_EQ(accepted({{proof.graph_text, proof.certificate_text}}), 1);
}

TEST_F(ProveToy, LimitsTheCallsOfALineInAnActivation) {
  const KernelProof proof = proof_of("Seldom"), sum = proof_of("Sum");
  ASSERT_TRUE(proof.proved()) << proof.reasons.front();
  EXPECT_GT(proof.certificate.bound, 3 * sum.certificate.bound);
  EXPECT_LT(proof.certificate.bound, 5 * sum.certificate.bound);
  EXPECT_EQ(accepted({{proof.graph_text, proof.certificate_text}}), 1);
  std::string more = proof.graph_text;
  more.replace(more.find("\nruns 3 "), 8, "\nruns 4 ");
  EXPECT_EQ(accepted({{more, proof.certificate_text}}), 0);
}

TEST_F(ProveToy, HoldsOnlyForTheMachineCodeOfTheProof) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const KernelProof sum = proof_of("Sum"), calls = proof_of("Calls");
  const std::string other(64, '0');
  const ProvedBounds bounds =
      bounds_of_program({"x86-64",
                         {},
                         {{"Sum", sum.root, sum.graph.code_sha256, sum.certificate.bound},
                          {"Calls", calls.root, other, calls.certificate.bound}}},
                        program);
  EXPECT_EQ(bounds.instructions,
            (std::map<std::string, std::int64_t>{{"Sum", sum.certificate.bound}}));
  ASSERT_TRUE(bounds.refused.contains("Calls"));
  EXPECT_EQ(bounds.refused.at("Calls"), "the program has other machine code than the proof");
  EXPECT_THROW((void)bounds_of_program({"arm64", {}, {}}, program), InputError);
}

// A kernel's edit that moves a loop is found here, before `glint budget prove` runs.
TEST(LoopBounds, OfTheKernelsNameTheLinesOfTheirLoops) {
  EXPECT_NO_THROW(
      LoopBounds(source_folder() + "/platform/budget/prove/loops.toml", source_folder()));
}

TEST_F(ProveToy, AcceptsItsCertificateAndRejectsDamagedOnes) {
  const KernelProof proof = proof_of("Calls");
  ASSERT_TRUE(proof.proved()) << proof.reasons.front();
  EXPECT_EQ(accepted({{proof.graph_text, proof.certificate_text}}), 1);
  std::vector<std::string> lines;
  std::istringstream text(proof.certificate_text);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  std::vector<Pair> damaged;
  const auto damage = [&](std::size_t number, const std::string& instead) {
    std::string certificate;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string& line = i == number ? instead : lines[i];
      if (!line.empty()) certificate += line + "\n";
    }
    damaged.push_back({proof.graph_text, certificate});
  };
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const std::size_t space = lines[i].rfind(' ');
    const std::int64_t value = std::stoll(lines[i].substr(space));
    damage(i, lines[i].substr(0, space + 1) + std::to_string(value - 1));
    damage(i, "");
  }
  damage(1, "graph " + std::string(64, '0'));
  damage(2, lines[2] + "0");
  std::string graph = proof.graph_text;
  graph.replace(graph.find("loop "), 5, "loop 1");
  damaged.push_back({graph, proof.certificate_text});
  EXPECT_GE(damaged.size(), 20u);
  EXPECT_EQ(accepted(damaged), 0);
}

}  // namespace
}  // namespace glint::prove
