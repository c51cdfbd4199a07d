// DDS Security: a run, and peers with and without rights. Certificates and documents that Glint
// does not make are made by the openssl program.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/dds_inputs.hpp"
#include "platform/sinks/dds/dds_process.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/security_files.hpp"
#include "platform/sinks/dds/security_keys.hpp"
#include "tests/unit/platform/sinks/dds/inputs.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace {
std::int64_t clock_shift_s = 0;
}

// Calendar time of this process only: the DDS process of a sink has the right one.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (clock == CLOCK_REALTIME) time->tv_sec += clock_shift_s;
  return static_cast<int>(result);
}
extern "C" time_t time(time_t* to) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (to != nullptr) *to = now.tv_sec;
  return now.tv_sec;
}

namespace glint {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t k_year_s = std::int64_t{365} * 24 * 3600;
constexpr int k_samples = 40;
// A peer in this process has a Cyclone domain of its own, whose number its rights must have.
constexpr int k_domain_max = 210;
const SecurityScope k_scope{0, k_domain_max, "", {0, 4'000'000'000}};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void run_command(const std::string& command) {
  ASSERT_EQ(std::system((command + " 2> /dev/null").c_str()), 0) << command;
}

// Keys of a run, of peers "viewer" and "panel", and of "guest" with an expired certificate beside.
class Security : public DdsTest {
 protected:
  void SetUp() override {
    DdsTest::SetUp();
    if (IsSkipped()) return;
    std::string pattern = (fs::temp_directory_path() / "glint_keys_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    const std::int64_t now = ::time(nullptr);
    KeySettings keys{
        folder_ / "keys", {0, k_domain_max, "", {now - 3 * k_year_s, now - k_year_s}}, {}};
    keys.peers = {{"guest", {}, {}}};
    write_security_keys(keys);
    fs::rename(enclave("guest") / "cert.pem", folder_ / "expired.pem");
    keys.peers.push_back({"viewer", {}, {}});
    keys.peers.push_back({"panel", {DdsInput::buttons}, {}});
    keys.scope.validity.to_s = now + k_year_s;
    write_security_keys(keys);
    keys.folder = folder_ / "other_keys";
    write_security_keys(keys);
  }
  void TearDown() override {
    clock_shift_s = 0;
    fs::remove_all(folder_);
  }

  [[nodiscard]] fs::path enclave(const std::string& identity) const {
    return folder_ / "keys" / "enclaves" / identity;
  }
  [[nodiscard]] fs::path other_enclave(const std::string& identity) const {
    return folder_ / "other_keys" / "enclaves" / identity;
  }
  static DdsSettings settings_of(const fs::path& keys) {
    DdsSettings settings = test_settings();
    settings.static_transforms = {{"hmd_world", "robot_base", Pose{}}};
    settings.security = keys.string();
    return settings;
  }
  // Signs a document by the authority of the keys.
  void sign(const std::string& text, const fs::path& to) const {
    std::ofstream(folder_ / "text.xml") << text;
    run_command("openssl smime -sign -text -in " + (folder_ / "text.xml").string() + " -signer " +
                (folder_ / "keys/public/ca.cert.pem").string() + " -inkey " +
                (folder_ / "keys/private/ca.key.pem").string() + " -out " + to.string());
  }
  // A governance under which a participant controls no access of its own.
  void disable_own_access_control(const fs::path& keys) const {
    std::string text = governance_text(k_scope);
    for (const std::string name : {"join", "read", "write"}) {
      const std::string strict = "<enable_" + name + "_access_control>true";
      text.replace(text.find(strict), strict.size(), "<enable_" + name + "_access_control>false");
    }
    sign(text, keys / "governance.p7s");
  }

  // A run, one panel that may press a button, and one other participant.
  struct Exchange {
    DdsSettings run;
    std::vector<ButtonEvent> events;
    DdsSink sink;
    DdsInputs inputs;
    explicit Exchange(const DdsSettings& settings)
        : run(settings), sink(run), inputs(sink.process(), run, [this](const ButtonEvent& event) {
            events.push_back(event);
          }) {
      sink.start();
    }
  };

  struct Received {
    std::size_t messages = 0, writers = 0;
    bool sent_button = false;
  };

  // What `other` receives while a granted peer receives all, and whether its button arrives.
  Received exchange_with(const DdsSettings& other) {
    Exchange run(settings_of(enclave("glint")));
    Peer intruder(other, 201);
    std::vector<dds_entity_t> readers;
    for (const auto& [type, topic] :
         {std::pair{status_type(), "rt/glint/pen_status"},
          std::pair{pose_stamped_type(), "rt/glint/pen_pose"}, std::pair{tf_type(), k_tf_topic},
          std::pair{diagnostics_type(), k_diagnostics_topic}}) {
      readers.push_back(
          intruder.reader(type, topic, Reliability::reliable, Durability::volatile_data, 200));
    }
    readers.push_back(intruder.reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                      Durability::transient_local, 10));
    const dds_entity_t button = intruder.writer(
        bool_type(), "rt/glint/button", Reliability::reliable, Durability::volatile_data, 1);
    const DdsSettings viewer_settings = settings_of(enclave("viewer"));
    Peer viewer(viewer_settings, 202);
    const dds_entity_t status =
        viewer.reader(status_type(), "rt/glint/pen_status", Reliability::reliable,
                      Durability::volatile_data, 200);
    EXPECT_TRUE(viewer.wait_for_discovery(run.sink));
    Peer panel(settings_of(enclave("panel")), 203);
    const dds_entity_t finish = panel.writer(bool_type(), "rt/glint/button_finish",
                                             Reliability::reliable, Durability::volatile_data, 1);
    EXPECT_TRUE(wait_until([&] { return has_reader(finish); }));
    // The other participant had all this time, and has that of the exchange.
    for (std::uint32_t tick = 0; tick < k_samples; ++tick) run.sink.offer(sample_at(tick));
    EXPECT_EQ(take<StatusMessage>(status, k_samples, [](const StatusMessage&) {}), k_samples);
    const BoolMessage pressed{true};
    Received received;
    EXPECT_TRUE(wait_until([&] {
      (void)dds_write(button, &pressed);
      (void)dds_write(finish, &pressed);
      run.inputs.read(milliseconds(2));
      return !run.events.empty() && run.events.back().button == Button::finish;
    }));
    for (int i = 0; i < 50; ++i) {
      (void)dds_write(button, &pressed);
      run.inputs.read(milliseconds(20));
    }
    for (const ButtonEvent& event : run.events) {
      received.sent_button = received.sent_button || event.button == Button::draw;
    }
    for (const dds_entity_t reader : readers) {
      if (reader < 0) continue;
      received.writers += has_writer(reader) ? 1 : 0;
      std::array<void*, 300> samples{};
      std::array<dds_sample_info_t, 300> infos{};
      const int taken = dds_take(reader, samples.data(), infos.data(), samples.size(), 300);
      received.messages += static_cast<std::size_t>(std::max(0, taken));
      if (taken > 0) dds_return_loan(reader, samples.data(), taken);
    }
    return received;
  }
  void expect_nothing_with(const DdsSettings& other) {
    const Received received = exchange_with(other);
    EXPECT_EQ(received.messages, 0u);
    EXPECT_EQ(received.writers, 0u);
    EXPECT_FALSE(received.sent_button);
  }

  fs::path folder_;
};

TEST_F(Security, GivesAGrantedPeerAll) {
  const Received viewer = exchange_with(settings_of(enclave("viewer")));
  EXPECT_EQ(viewer.writers, 5u);
  EXPECT_GE(viewer.messages, 3u * k_samples + 2) << "status, pose, tf; diagnostics, tf_static";
  EXPECT_FALSE(viewer.sent_button) << "it has no right to send";
}

TEST_F(Security, TakesAButtonFromAPeerThatHasTheRight) {
  EXPECT_TRUE(exchange_with(settings_of(enclave("panel"))).sent_button);
}

TEST_F(Security, GivesNothingToAParticipantWithoutSecurity) {
  expect_nothing_with(settings_of(""));
}

TEST_F(Security, GivesNothingToAnIdentityOfAnotherAuthority) {
  expect_nothing_with(settings_of(other_enclave("panel")));
}

TEST_F(Security, GivesNothingToAnIdentityWithoutRights) {
  std::string text = peer_permissions_text({"guest", {}, {}}, k_scope);
  const std::size_t from = text.find("<allow_rule>"), to = text.find("<default>");
  text.erase(from, to - from);
  sign(text, enclave("guest") / "permissions.p7s");
  disable_own_access_control(enclave("guest"));
  expect_nothing_with(settings_of(enclave("guest")));
}

TEST_F(Security, GivesNothingToAnIdentityWithTheRightsOfAnother) {
  fs::copy_file(enclave("panel") / "permissions.p7s", enclave("guest") / "permissions.p7s",
                fs::copy_options::overwrite_existing);
  disable_own_access_control(enclave("guest"));
  expect_nothing_with(settings_of(enclave("guest")));
}

TEST_F(Security, GivesNothingToAnIdentityWithRightsOfAnotherAuthority) {
  for (const char* name : {"permissions_ca.cert.pem", "governance.p7s", "permissions.p7s"}) {
    fs::copy_file(other_enclave("panel") / name, enclave("panel") / name,
                  fs::copy_options::overwrite_existing);
  }
  // The granted panel of the exchange has these files too: a second identity instead.
  fs::remove_all(enclave("guest"));
  fs::rename(enclave("panel"), enclave("guest"));
  const std::int64_t now = ::time(nullptr);
  KeySettings keys{folder_ / "keys", {0, k_domain_max, "", {now - k_year_s, now + k_year_s}}, {}};
  keys.peers = {{"panel", {DdsInput::buttons}, {}}};
  write_security_keys(keys);
  expect_nothing_with(settings_of(enclave("guest")));
}

// A peer whose own governance controls no access may create the writer; the run refuses it.
TEST_F(Security, RefusesAButtonOfAPeerThatMayOnlyReceive) {
  disable_own_access_control(enclave("guest"));
  EXPECT_FALSE(exchange_with(settings_of(enclave("guest"))).sent_button);
}

// The peer's own clock is late: its own check accepts its certificate.
TEST_F(Security, GivesNothingToAnExpiredCertificate) {
  clock_shift_s = -2 * k_year_s;
  EXPECT_GE(exchange_with(settings_of(enclave("guest"))).messages, 3u * k_samples);
  fs::copy_file(folder_ / "expired.pem", enclave("guest") / "cert.pem",
                fs::copy_options::overwrite_existing);
  Peer alone(settings_of(enclave("guest")), 204);
  EXPECT_GT(alone.participant(), 0) << "its own check accepts the certificate";
  expect_nothing_with(settings_of(enclave("guest")));
}

TEST_F(Security, NamesAFileThatIsMissingOrInvalid) {
  const auto message_of = [&] {
    try {
      DdsSink sink(settings_of(enclave("glint")));
      return std::string("none");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  for (const SecurityFile& file : {k_identity_ca, k_certificate, k_private_key, k_permissions_ca,
                                   k_governance, k_permissions}) {
    const fs::path path = enclave("glint") / file.name, kept = folder_ / "kept";
    fs::rename(path, kept);
    EXPECT_EQ(message_of(), "dds.security: " + path.string() +
                                ": No such file or directory; expected a folder of `glint dds "
                                "keys`");
    std::ofstream(path) << "";
    EXPECT_NE(message_of().find(path.string() + ": is empty"), std::string::npos) << message_of();
    std::ofstream(path) << "no key\n";
    EXPECT_NE(message_of().find("dds.security: " + enclave("glint").string()), std::string::npos)
        << message_of();
    fs::rename(kept, path);
  }
  EXPECT_EQ(message_of(), "none");
}

TEST_F(Security, WritesKeysThatOnlyTheirOwnerReads) {
  int keys = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.path().string().find("key.pem") == std::string::npos) continue;
    struct stat status {};
    ASSERT_EQ(stat(entry.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u) << entry.path();
    ++keys;
  }
  EXPECT_EQ(keys, 10) << "two authorities, each with a run and three peers";
}

TEST_F(Security, WritesWhatOpensslVerifies) {
  const std::string authority = (folder_ / "keys/public/ca.cert.pem").string();
  for (const std::string identity : {"glint", "viewer", "panel", "guest"}) {
    const std::string at = enclave(identity).string();
    run_command("openssl verify -CAfile " + authority + " " + at + "/cert.pem > /dev/null");
    for (const std::string name : {"governance", "permissions"}) {
      run_command("openssl smime -verify -text -CAfile " + authority + " -in " + at + "/" + name +
                  ".p7s -out " + (folder_ / "read.xml").string());
      EXPECT_EQ(text_of(folder_ / "read.xml").find("<?xml"), 0u);
    }
  }
}

TEST_F(Security, KeepsKeysWhenCalledAgain) {
  const std::string key = text_of(enclave("panel") / "key.pem");
  const std::string certificate = text_of(enclave("panel") / "cert.pem");
  const std::string authority = text_of(folder_ / "keys/public/ca.cert.pem");
  KeySettings keys{folder_ / "keys", k_scope, {{"panel", {}, {}}}};
  write_security_keys(keys);
  EXPECT_EQ(text_of(enclave("panel") / "key.pem"), key);
  EXPECT_EQ(text_of(folder_ / "keys/public/ca.cert.pem"), authority);
  EXPECT_NE(text_of(enclave("panel") / "cert.pem"), certificate);
}

}  // namespace
}  // namespace glint
