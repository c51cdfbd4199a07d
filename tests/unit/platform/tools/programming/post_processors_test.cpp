// Each post-processor on 30 strokes, read back by the dialect's own reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

#include "platform/input_error.hpp"
#include "platform/tools/programming/fanuc_ls.hpp"
#include "platform/tools/programming/program_format.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/platform/tools/programming/program_reader.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

struct Dialect {
  const char* name;
  ProgramFormat format;
  test::ReadProgram (*read)(const std::string&);
};

const Dialect k_dialects[] = {{"urscript", ProgramFormat::urscript, test::read_urscript},
                              {"krl", ProgramFormat::krl, test::read_krl},
                              {"rapid", ProgramFormat::rapid, test::read_rapid},
                              {"ls", ProgramFormat::ls, test::read_ls}};

Quaternion about(const Vector3& axis, double degrees) {
  return Quaternion(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

// A third of the orientations is random; the others have a middle angle of +-90 degrees, or next to
// it by 1e-9 to 1e-2 degrees.
Quaternion orientation(test::Random& random, int kind) {
  if (kind % 3 == 0) return random.rotation();
  const double next =
      kind % 3 == 1 ? 0 : std::pow(10.0, random.within(-9, -2)) * (random.below(2) ? 1 : -1);
  return about(Vector3::UnitZ(), random.within(-180, 180)) *
         about(Vector3::UnitY(), (random.below(2) ? 90 : -90) + next) *
         about(Vector3::UnitX(), random.within(-180, 180));
}

// 30 strokes of 2 to 12 points, 0.02 to 30 mm apart, and a waypoint or two after each third.
DrawnPath thirty_strokes(std::uint64_t random_seed) {
  test::Random random(random_seed);
  DrawnPath path;
  int number = 0;
  const auto add = [&](PathKind kind, int points) {
    PathElement element{kind, {}};
    Vector3 at = random.in_box(4);
    for (int i = 0; i < points; ++i) {
      at += random.vector(1).normalized() * 1e-3 * std::pow(10.0, random.within(-1.7, 1.5));
      element.points.push_back(
          {Time{}, {orientation(random, number++), at}, Matrix6::Identity() * 1e-8});
    }
    path.push_back(element);
  };
  for (int stroke = 0; stroke < 30; ++stroke) {
    add(PathKind::stroke, 2 + random.below(11));
    for (int i = 0; stroke % 3 == 0 && i < 1 + random.below(2); ++i) add(PathKind::waypoint, 1);
  }
  return path;
}

double degrees_between(const Matrix3& a, const Matrix3& b) {
  return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0))) * 180 / std::numbers::pi;
}

ProgramSettings sample_settings() {
  ProgramSettings settings;
  settings.travel_m_s = 0.29;
  settings.stroke_m_s = 0.037;
  settings.acceleration_m_s2 = 0.7;
  settings.blend_m = 0.006;
  settings.recording = "run.mcap, tool pen";
  settings.user_frame = 3;
  settings.tool_frame = 2;
  return settings;
}

// LS has whole millimetres from 1.
double stated_blend(const Dialect& dialect, double blend_m) {
  if (dialect.format != ProgramFormat::ls || blend_m == 0) return blend_m;
  return std::max(1.0, std::floor(1e3 * blend_m + 1e-6)) / 1e3;
}

TEST(PostProcessors, AreReadBackTo1MicrometreAnd1MillidegreeOn30Strokes) {
  for (const std::uint64_t random_seed : {11u, 1207u, 90210u}) {
    const DrawnPath path = thirty_strokes(random_seed);
    const RobotProgram program = robot_program(path, sample_settings());
    ASSERT_EQ(program.moves.size(), point_count(path));
    for (const Dialect& dialect : k_dialects) {
      SCOPED_TRACE(dialect.name);
      const test::ReadProgram read =
          dialect.read(path_text({path}, sample_settings(), dialect.format));
      ASSERT_EQ(read.moves.size(), program.moves.size());
      double worst_m = 0, worst_deg = 0;
      int blends = 0;
      for (std::size_t i = 0; i < read.moves.size(); ++i) {
        const RobotMove& move = program.moves[i];
        const Pose& pose = move.pose;
        worst_m = std::max(worst_m, (read.moves[i].position_m - pose.translation).norm());
        worst_deg = std::max(
            worst_deg, degrees_between(read.moves[i].rotation, pose.rotation.toRotationMatrix()));
        EXPECT_NEAR(read.moves[i].speed_m_s, move.speed_m_s, 1e-9) << i;
        EXPECT_NEAR(read.moves[i].blend_m, stated_blend(dialect, move.blend_m), 1e-9) << i;
        blends += read.moves[i].blend_m > 0 ? 1 : 0;
      }
      EXPECT_LT(worst_m, 1e-6);
      EXPECT_LT(worst_deg, 1e-3);
      EXPECT_GT(blends, 60);
      std::printf("%-8s %zu moves, %d blends: %.3f um, %.6f deg\n", dialect.name, read.moves.size(),
                  blends, 1e6 * worst_m, worst_deg);
    }
  }
}

// A position of the program in its frame, or in the base.
Vector3 in_base(const test::ReadProgram& program, const Vector3& position_m) {
  if (!program.frame) return position_m;
  return program.frame->rotation * position_m + program.frame->position_m;
}

// Strokes of a line and an arc: the circular moves of each language are those of the program, in a
// user frame, too.
TEST(PostProcessors, CircularMovesAreReadBack) {
  test::Random random(31);
  DrawnPath path;
  const int strokes = test::repetitions(10, 1);
  for (int stroke = 0; stroke < strokes; ++stroke) {
    PathElement element{PathKind::stroke, {}};
    const Pose frame{random.rotation(), random.in_box(1)};
    const Quaternion grip = random.rotation();
    for (int i = 0; i < 80; ++i) {
      const double angle = std::max(0, i - 30) * 0.04;
      const Vector3 at(0.05 * std::sin(angle), 0.05 * (1 - std::cos(angle)),
                       0.002 * std::min(0, i - 30));
      element.points.push_back({Time{i}, {grip, frame * at}, Matrix6::Identity() * 1e-10});
    }
    path.push_back(element);
  }
  ProgramSettings settings = sample_settings();
  settings.shapes.emplace();
  const RobotProgram program = robot_program(path, settings);
  EXPECT_LT(program.moves.size(), static_cast<std::size_t>(6 * strokes));
  for (std::size_t n = 0; n < 2 * std::size(k_dialects); ++n) {
    const Dialect& dialect = k_dialects[n / 2];
    const bool framed = n % 2 == 1;
    SCOPED_TRACE(std::string(dialect.name) + (framed ? " in a user frame" : ""));
    settings.T_robot_user.reset();
    if (framed) settings.T_robot_user = Pose{random.rotation(), random.in_box(1)};
    settings.user_frame = framed && dialect.format != ProgramFormat::ls ? 0 : 3;
    const test::ReadProgram read = dialect.read(path_text({path}, settings, dialect.format));
    ASSERT_EQ(read.frame.has_value(), framed);
    ASSERT_EQ(read.moves.size(), program.moves.size());
    int circular = 0;
    for (std::size_t i = 0; i < read.moves.size(); ++i) {
      const RobotMove& move = program.moves[i];
      EXPECT_LT((in_base(read, read.moves[i].position_m) - move.pose.translation).norm(), 1e-6);
      ASSERT_EQ(read.moves[i].circular, move.via.has_value());
      if (!move.via) continue;
      ++circular;
      EXPECT_LT((in_base(read, read.moves[i].via_m) - move.via->translation).norm(), 1e-6);
    }
    EXPECT_GE(circular, strokes);
  }
}

// The moves are in the frame; the frame that the program defines, or states, takes them to the
// base.
TEST(PostProcessors, MovesInAUserFrameAreThoseInTheBaseTo1MicrometreAnd1Millidegree) {
  for (const std::uint64_t random_seed : {17u, 2203u, 70001u}) {
    test::Random random(random_seed);
    const DrawnPath path = thirty_strokes(random_seed);
    for (const Dialect& dialect : k_dialects) {
      SCOPED_TRACE(dialect.name);
      ProgramSettings settings = sample_settings();
      settings.user_frame = dialect.format == ProgramFormat::ls ? 3 : 0;
      const RobotProgram program = robot_program(path, settings);
      settings.T_robot_user = Pose{orientation(random, random.below(3)), random.in_box(2)};
      const test::ReadProgram read = dialect.read(path_text({path}, settings, dialect.format));
      ASSERT_TRUE(read.frame);
      ASSERT_EQ(read.moves.size(), program.moves.size());
      double worst_m = 0, worst_deg = 0, nearest_m = 1e9;
      for (std::size_t i = 0; i < read.moves.size(); ++i) {
        const Pose& pose = program.moves[i].pose;
        const Vector3 at = in_base(read, read.moves[i].position_m);
        worst_m = std::max(worst_m, (at - pose.translation).norm());
        worst_deg =
            std::max(worst_deg, degrees_between(read.frame->rotation * read.moves[i].rotation,
                                                pose.rotation.toRotationMatrix()));
        nearest_m = std::min(nearest_m, (read.moves[i].position_m - pose.translation).norm());
        EXPECT_NEAR(read.moves[i].blend_m, stated_blend(dialect, program.moves[i].blend_m), 1e-9);
      }
      EXPECT_LT(worst_m, 1e-6);
      EXPECT_LT(worst_deg, 1e-3);
      EXPECT_GT(nearest_m, 1e-3);  // not written in the base
      const Pose& frame = *settings.T_robot_user;
      EXPECT_LT((read.frame->position_m - frame.translation).norm(), 1e-6);
      EXPECT_LT(degrees_between(read.frame->rotation, frame.rotation.toRotationMatrix()), 1e-5);
      std::string comments;
      for (const std::string& line : read.comments) comments += line + ' ';
      EXPECT_NE(comments.find("User frame in the robot's base: X "), std::string::npos);
      std::printf("%-8s in a user frame: %.3f um, %.6f deg\n", dialect.name, 1e6 * worst_m,
                  worst_deg);
    }
  }
}

TEST(PostProcessors, StateNameFramesAccelerationAndWhatIsNotChecked) {
  const DrawnPath path = thirty_strokes(5);
  for (const Dialect& dialect : k_dialects) {
    SCOPED_TRACE(dialect.name);
    const bool urscript = dialect.format == ProgramFormat::urscript;
    const bool ls = dialect.format == ProgramFormat::ls;
    const test::ReadProgram read =
        dialect.read(path_text({path}, sample_settings(), dialect.format));
    EXPECT_EQ(read.name, ls ? "GLINT_PATH" : "glint_path");
    EXPECT_EQ(read.user_frame, urscript ? -1 : 3);
    EXPECT_EQ(read.tool_frame, urscript ? -1 : 2);
    EXPECT_EQ(read.acceleration_m_s2, ls ? -1 : 0.7);
    std::string comments;
    for (const std::string& line : read.comments) comments += line + ' ';
    for (const char* part : {"NOT CHECKED: reachability", "run.mcap, tool pen", "1: stroke of"}) {
      EXPECT_NE(comments.find(part), std::string::npos) << part << " in " << comments;
    }
  }
}

// Angles from the manuals' definitions: A 90 turns x to y; B 90 turns x to -z; C 90 turns y to z.
TEST(PostProcessors, WriteQuarterTurnsAsTheManualsDefineThem) {
  DrawnPath path;
  for (const Vector3& axis : std::vector<Vector3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}) {
    path.push_back({PathKind::waypoint,
                    {{Time{}, {about(axis, 90), Vector3(0.5, -0.25, 0.125)}, Matrix6::Zero()}}});
  }
  const std::string krl = path_text({path}, {}, ProgramFormat::krl);
  const std::string place = "LIN {X 500.0000,Y -250.0000,Z 125.0000,";
  EXPECT_NE(krl.find(place + "A 90.00000,B 0.00000,C 0.00000}"), std::string::npos) << krl;
  EXPECT_NE(krl.find(",B 90.00000,"), std::string::npos) << krl;
  EXPECT_NE(krl.find(place + "A 0.00000,B 0.00000,C 90.00000}"), std::string::npos) << krl;
  const std::string ls = path_text({path}, {}, ProgramFormat::ls);
  EXPECT_NE(ls.find("W = 0.00000 deg,\tP = 0.00000 deg,\tR = 90.00000 deg"), std::string::npos);
  EXPECT_NE(ls.find("W = 90.00000 deg,\tP = 0.00000 deg,\tR = 0.00000 deg"), std::string::npos);
  const std::string rapid = path_text({path}, {}, ProgramFormat::rapid);
  EXPECT_NE(rapid.find("[0.70710678,0.00000000,0.00000000,0.70710678]"), std::string::npos);
}

// Each line in turn is cut in its middle.
TEST(ProgramReaders, RejectAProgramWithADamagedLine) {
  DrawnPath path = thirty_strokes(21);
  path.resize(3);
  ProgramSettings settings = sample_settings();
  settings.name = "g";  // part of a longer name would be a name
  for (const Dialect& dialect : k_dialects) {
    std::istringstream text(path_text({path}, settings, dialect.format));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    int damaged = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::size_t begin = lines[i].find_first_not_of(" \t");
      if (std::string("#;!").find(lines[i][begin]) != std::string::npos) continue;
      std::string program;
      for (std::size_t k = 0; k < lines.size(); ++k) {
        program += (k == i ? lines[k].substr(0, begin + (lines[k].size() - begin) / 2) : lines[k]);
        program += '\n';
      }
      ++damaged;
      EXPECT_THROW((void)dialect.read(program), std::runtime_error)
          << dialect.name << ": " << lines[i];
    }
    EXPECT_GT(damaged, 15);
  }
}

TEST(PostProcessors, CleanForeignText) {
  ProgramSettings settings = sample_settings();
  settings.recording =
      "a\nhalt()\r;END\xC3\xA9 ! of a name that is longer than a remark of 32 letters";
  const DrawnPath path = thirty_strokes(8);
  for (const Dialect& dialect : k_dialects) {
    const test::ReadProgram read = dialect.read(path_text({path}, settings, dialect.format));
    EXPECT_EQ(read.moves.size(), point_count(path)) << dialect.name;
    for (const std::string& line : read.comments) {
      EXPECT_TRUE(
          std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; }))
          << dialect.name << ": " << line;
    }
  }
}

std::string refusal(const DrawnPath& path, const ProgramSettings& settings, ProgramFormat format) {
  try {
    (void)path_text({path}, settings, format);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PostProcessors, RefuseWhatTheControllerWouldRefuse) {
  const DrawnPath path = thirty_strokes(3);
  const auto message = [&](ProgramFormat format, auto change) {
    ProgramSettings settings;
    change(settings);
    return refusal(path, settings, format);
  };
  const auto named = [](std::string name) {
    return [name](ProgramSettings& settings) { settings.name = name; };
  };
  using enum ProgramFormat;
  EXPECT_EQ(message(krl, named(std::string(24, 'a'))), "accepted");
  EXPECT_EQ(message(krl, named(std::string(25, 'a'))),
            "krl: name \"" + std::string(25, 'a') + "\"; expected at most 24 characters");
  EXPECT_EQ(message(rapid, named(std::string(29, 'a'))),
            "rapid: name \"" + std::string(29, 'a') + "\"; expected at most 28 characters");
  EXPECT_EQ(message(ls, named(std::string(37, 'a'))),
            "ls: name \"" + std::string(37, 'a') + "\"; expected at most 36 characters");
  EXPECT_EQ(message(krl, named("Ptp")), "krl: name \"Ptp\"; expected no reserved word");
  EXPECT_EQ(message(rapid, named("module")), "rapid: name \"module\"; expected no reserved word");
  EXPECT_EQ(message(urscript, named("def")), "urscript: name \"def\"; expected no reserved word");
  EXPECT_EQ(message(ls, named("con")), "ls: name \"con\"; expected no reserved word");
  EXPECT_EQ(message(ls, [](auto& s) { s.tool_frame = 0; }),
            "ls: tool frame is 0; expected 1 to 10");
  EXPECT_EQ(message(krl, [](auto& s) { s.user_frame = 33; }),
            "krl: user frame is 33; expected 0 to 32");
  EXPECT_EQ(message(ls, [](auto& s) { s.travel_m_s = 2.5; }),
            "ls: speed in mm/s is 2500; expected 1 to 2000");
  EXPECT_EQ(message(rapid, [](auto& s) { s.acceleration_m_s2 = 0.05; }),
            "rapid: acceleration is 0.05; expected 0.1 to 1000");
  EXPECT_EQ(message(ls, [](auto& s) { s.T_robot_user = Pose{}; }),
            "ls: user frame is 0; expected 1 to 9");
  EXPECT_EQ(message(krl,
                    [](auto& s) {
                      s.T_robot_user = Pose{};
                      s.user_frame = 2;
                    }),
            "number of the user frame 2 besides a drawn frame, which the program defines; expected "
            "0, or the format ls");
  for (const Dialect& dialect : k_dialects) {
    EXPECT_EQ(refusal({}, {}, dialect.format),
              "robot program: no point in the path; expected one or more");
  }
}

TEST(PostProcessors, NameTheNumberOfPositionsThatDoNotFit) {
  DrawnPath path(k_fanuc_positions_max, {PathKind::waypoint, {{}}});
  EXPECT_EQ(refusal(path, {}, ProgramFormat::ls), "accepted");
  path.push_back(path.front());
  EXPECT_EQ(refusal(path, {}, ProgramFormat::ls),
            "ls: 1501 positions; expected at most 1500 in one program; set a wider --spacing");
}

TEST(RobotProgram, RefusesAPoseThatIsNotFinite) {
  DrawnPath path = thirty_strokes(4);
  path[2].points[0].pose.translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(path, {}, ProgramFormat::krl),
            "robot program: element 3: a pose that is not finite");
}

TEST(ProgramFormat, FollowsTheNameOrTheSuffix) {
  EXPECT_EQ(program_format("", "out/a.script"), ProgramFormat::urscript);
  EXPECT_EQ(program_format("", "A.SRC"), ProgramFormat::krl);
  EXPECT_EQ(program_format("", "a.b.mod"), ProgramFormat::rapid);
  EXPECT_EQ(program_format("", "a.ls"), ProgramFormat::ls);
  EXPECT_EQ(program_format("", "a.csv"), ProgramFormat::csv);
  EXPECT_EQ(program_format("", "a.json"), ProgramFormat::json);
  EXPECT_EQ(program_format("", "a.MCAP"), ProgramFormat::mcap);
  EXPECT_EQ(program_format("krl", "a.ls"), ProgramFormat::krl);
  EXPECT_THROW((void)program_format("", "a.txt"), InputError);
  EXPECT_THROW((void)program_format("", "ls"), InputError);
  EXPECT_THROW((void)program_format("KRL", "a.ls"), InputError);
}

TEST(ProgramFormat, NamesTheProgramAfterItsFile) {
  EXPECT_EQ(program_name("out/weld seam-2.src"), "weld_seam_2");
  EXPECT_EQ(program_name("1st.ls"), "p_1st");
  EXPECT_EQ(program_name("\xC3\xA9.mod"), "p___");
}

}  // namespace
}  // namespace glint
