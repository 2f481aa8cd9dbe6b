// What is kept from one start to the next, and what is not believed.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Cache : public testing::Test {
protected:
  ReconstructionCache open(const std::string& fingerprint = "this machine") {
    return ReconstructionCache{folder / "made" / "for it", fingerprint};
  }
  void keep() {
    auto cache = open();
    cache.remember("1024 u16", {700, 1500});
    const auto saved = cache.save();
    ASSERT_TRUE(saved) << saved.error().message;
  }
  fs::path file() const { return folder / "made/for it/reconstruction.json"; }

  tests::ScratchFolder folder;
};

TEST_F(Cache, remembers_across_starts) {
  EXPECT_FALSE(open().recall("1024 u16"));
  keep();
  const auto times = open().recall("1024 u16");
  ASSERT_TRUE(times);
  EXPECT_EQ(times->fused_ns, 700);
  EXPECT_EQ(times->fftw_ns, 1500);
  EXPECT_FALSE(open().recall("2048 u16"));
  EXPECT_EQ(std::distance(fs::directory_iterator{file().parent_path()}, {}), 1);
}

TEST_F(Cache, is_not_written_when_nothing_is_new) {
  keep();
  const auto written = fs::last_write_time(file()) - std::chrono::hours{1};
  fs::last_write_time(file(), written);
  auto cache = open();
  EXPECT_TRUE(cache.save());
  EXPECT_EQ(fs::last_write_time(file()), written);
}

TEST_F(Cache, begins_afresh_for_another_program_or_processor) {
  keep();
  auto other = open("another machine");
  EXPECT_FALSE(other.recall("1024 u16"));
  other.remember("512 u8", {1, 2});
  ASSERT_TRUE(other.save());
  EXPECT_TRUE(open("another machine").recall("512 u8"));
  EXPECT_FALSE(open().recall("1024 u16")); // replaced
}

TEST_F(Cache, passes_over_what_is_broken) {
  keep();
  std::ifstream in{file()};
  const auto good = nlohmann::json::parse(in);
  auto with = [&](const auto& change) {
    auto root = good;
    change(root);
    return root.dump();
  };
  using J = nlohmann::json;
  const std::string texts[] = {
      "",
      "{",
      "[]",
      "3",
      good.dump().substr(0, good.dump().size() / 2),
      std::string(2 << 20, ' '),
      with([](J& r) { r["ns_per_line"] = 7; }),
      with([](J& r) { r["ns_per_line"]["1024 u16"] = "fast"; }),
      with([](J& r) { r["ns_per_line"]["1024 u16"]["fused"] = -1; }),
      with([](J& r) { r["ns_per_line"]["1024 u16"].erase("fftw"); }),
      with([](J& r) { r["written_by"] = J::array(); }),
  };
  for (const std::string& text : texts) {
    std::ofstream{file()} << text;
    auto cache = open();
    EXPECT_FALSE(cache.recall("1024 u16")) << text.substr(0, 60);
    cache.remember("1024 u16", {3, 4});
    EXPECT_TRUE(cache.save());
    EXPECT_TRUE(open().recall("1024 u16"));
  }
  std::ofstream{file()} << with([](J& r) { r["fftw_wisdom"] = "(rubbish"; });
  EXPECT_TRUE(open().recall("1024 u16"));
}

TEST_F(Cache, says_what_keeps_it_from_writing) {
  folder.write("occupied", "a file where a folder is needed");
  ReconstructionCache blocked{folder / "occupied", "this machine"};
  blocked.remember("1024 u16", {1, 2});
  EXPECT_TRUE(blocked.recall("1024 u16"));
  EXPECT_THAT(blocked.save(), tests::FailsSaying((folder / "occupied").string()));

  ReconstructionCache homeless{std::nullopt, "this machine"};
  homeless.remember("1024 u16", {1, 2});
  EXPECT_THAT(homeless.save(), tests::FailsSaying("XDG_CACHE_HOME"));
}

class Variable { // of the environment, for as long as this lives
public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name))
      before_ = before;
    value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(CacheFolder, is_the_services_then_the_users) {
  const Variable home{"HOME", "/home/someone"};
  const Variable xdg{"XDG_CACHE_HOME", nullptr};
  const Variable service{"CACHE_DIRECTORY", nullptr};
  EXPECT_EQ(cache_folder(), "/home/someone/.cache/octascope");
  const Variable relative{"XDG_CACHE_HOME", "not/absolute"};
  EXPECT_EQ(cache_folder(), "/home/someone/.cache/octascope");
  const Variable chosen{"XDG_CACHE_HOME", "/cache"};
  EXPECT_EQ(cache_folder(), "/cache/octascope");
  const Variable systemd{"CACHE_DIRECTORY", "/var/cache/octascope:/var/cache/other"};
  EXPECT_EQ(cache_folder(), "/var/cache/octascope");
}

TEST(CacheFolder, is_nowhere_without_a_home) {
  const Variable home{"HOME", nullptr};
  const Variable xdg{"XDG_CACHE_HOME", nullptr};
  const Variable service{"CACHE_DIRECTORY", nullptr};
  EXPECT_EQ(cache_folder(), std::nullopt);
}

TEST(MachineFingerprint, names_program_and_processor) {
  EXPECT_THAT(machine_fingerprint(), HasSubstr("octascope 0."));
  EXPECT_THAT(machine_fingerprint(), HasSubstr(processor_name()));
  EXPECT_FALSE(processor_name().empty());
}

} // namespace
} // namespace octascope::firmware_host
