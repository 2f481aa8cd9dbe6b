// What keeps a configuration together and keeps the picture when one is broken.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/configuration/configuration_bundle.h"
#include "firmware-host/configuration/configuration_check.h"
#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/configuration/kept/last_good.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using ui::ConfigurationState;

class ConfigurationFiles : public testing::Test {
protected:
  // A configuration that names files of every kind, in other folders and by absolute names.
  ConfigurationFiles() {
    fs::create_directories(folder_ / "etc/tables");
    fs::create_directories(folder_ / "opt");
    fs::create_directories(folder_ / "state");
    std::string curve;
    for (int i = 0; i < 32; ++i)
      curve += std::to_string(i) + "\n";
    folder_.write("etc/tables/k.txt", curve);
    folder_.write("etc/tables/dispersion.txt", curve);
    folder_.write("etc/tables/dark.txt", curve);
    folder_.write("opt/calibration.toml",
                  "[spectrometer]\nsamples = 32\n"
                  "[k_linear]\ntable = \"../etc/tables/k.txt\" # µ before nothing\n"
                  "[dispersion]\ntable = '../etc/tables/dispersion.txt'\n"
                  "[background]\nmode = \"file\"\nfile = \"../etc/tables/dark.txt\"\n");
    folder_.write("opt/look.csv", "0\n0.5\n1\n");
    folder_.write("opt/lens.toml",
                  "[spectrometer]\nsamples = 32\n[k_linear]\npolynomial = [0, 1]\n");
    write_configuration("b_scans = 20");
  }

  void write_configuration(const std::string& scan) const {
    folder_.write("etc/octascope.toml",
                  "# größer\n[scan]\nsamples = 32\n" + scan +
                      "\n[calibration]\nfile = \"../opt/calibration.toml\"\n"
                      "[[transfer]]\nname = \"mine\"\nkind = \"table\"\nfile = \"" +
                      (folder_ / "opt/look.csv").string() +
                      "\"\n[microscope]\nobjective = \"f 200\"\n"
                      "[[objective]]\nname = \"f 200\"\na_mm = 6\n"
                      "[[objective]]\nname = \"größer\"\ncalibration = \"../opt/lens.toml\"\n");
  }
  fs::path own() const { return folder_ / "etc/octascope.toml"; }
  fs::path state() const { return folder_ / "state"; }
  hal::Result<> keep() const {
    const auto bundle = ConfigurationBundle::gather(own());
    return bundle ? LastGood{state()}.keep(*bundle) : tl::make_unexpected(bundle.error());
  }
  hal::Result<ChosenConfiguration> choose() const {
    RunOptions options;
    options.configuration = own();
    return choose_configuration(options, state());
  }

  tests::ScratchFolder folder_;
};

TEST_F(ConfigurationFiles, are_good_as_a_whole) {
  const auto read = load_whole_configuration(own());
  ASSERT_TRUE(read) << read.error().message;
}

TEST_F(ConfigurationFiles, stay_together_when_the_originals_are_gone) {
  ASSERT_TRUE(keep());
  fs::remove_all(folder_ / "etc");
  fs::remove_all(folder_ / "opt");
  const auto file = tests::must(LastGood{state()}.file());
  const auto read = tests::must(load_whole_configuration(file));
  EXPECT_EQ(read.plan->b_scans, 20);
  EXPECT_EQ(read.look.transfers.functions().back().name, "mine");
  EXPECT_EQ(read.objectives.size(), 2U);
  EXPECT_THAT(tests::whole_file(file), HasSubstr("# größer"))
      << "with the comments that people wrote";
}

TEST_F(ConfigurationFiles, that_name_what_cannot_be_read_are_not_kept) {
  ASSERT_TRUE(keep());
  fs::remove(folder_ / "etc/tables/dispersion.txt");
  EXPECT_THAT(keep(), tests::FailsSaying("dispersion.txt"));
  EXPECT_TRUE(load_whole_configuration(*LastGood{state()}.file())) << "the older one stays";
}

TEST_F(ConfigurationFiles, that_name_a_file_to_write_are_kept_without_it) {
  const std::string name = (folder_ / "metrics.prom").string();
  folder_.write("etc/octascope.toml", "[observation]\nmetrics = \"" + name + "\"\n");
  ASSERT_TRUE(keep());
  EXPECT_EQ(load_whole_configuration(*LastGood{state()}.file())->metrics, name);
}

TEST_F(ConfigurationFiles, of_a_name_in_three_quotes_are_not_guessed_at) {
  folder_.write("etc/octascope.toml", "[controls]\nfile = \"\"\"pedal.toml\"\"\"\n");
  folder_.write("etc/pedal.toml", "");
  EXPECT_THAT(ConfigurationBundle::gather(own()), tests::FailsSaying("simple quotes"));
}

TEST_F(ConfigurationFiles, are_replaced_as_a_whole) {
  ASSERT_TRUE(keep());
  write_configuration("b_scans = 40");
  ASSERT_TRUE(keep());
  EXPECT_EQ(load_configuration(*LastGood{state()}.file())->plan->b_scans, 40);
  write_configuration("b_scans = 60");
  ASSERT_TRUE(keep());
  EXPECT_EQ(load_configuration(*LastGood{state()}.file())->plan->b_scans, 60);
}

// A power cut while the other folder was written leaves any rubbish in it.
TEST_F(ConfigurationFiles, that_were_half_written_are_never_used) {
  ASSERT_TRUE(keep());
  for (const char* name : {"state/last-good.a", "state/last-good.b"})
    if (!fs::exists(folder_ / name)) {
      fs::create_directory(folder_ / name);
      folder_.write(std::string{name} + "/octascope.toml", "[sc");
    }
  EXPECT_TRUE(load_whole_configuration(*LastGood{state()}.file()));
  write_configuration("b_scans = 40");
  ASSERT_TRUE(keep());
  EXPECT_EQ(load_whole_configuration(*LastGood{state()}.file())->plan->b_scans, 40);
}

TEST_F(ConfigurationFiles, that_did_not_change_are_not_written_again) {
  ASSERT_TRUE(keep());
  const auto before = fs::read_symlink(state() / "last-good");
  ASSERT_TRUE(keep());
  EXPECT_EQ(fs::read_symlink(state() / "last-good"), before);
}

TEST_F(ConfigurationFiles, in_order_are_used_themselves) {
  const auto chosen = tests::must(choose());
  EXPECT_EQ(chosen.state, ConfigurationState::own);
  EXPECT_EQ(chosen.used, own());
  EXPECT_EQ(configuration_notice(chosen), "");
}

TEST_F(ConfigurationFiles, that_are_broken_give_way_to_the_last_good_ones) {
  ASSERT_TRUE(keep());
  write_configuration("b_scans = 0");
  const auto chosen = tests::must(choose());
  EXPECT_EQ(chosen.state, ConfigurationState::last_good);
  EXPECT_EQ(chosen.configuration.plan->b_scans, 20);
  EXPECT_EQ(chosen.used, LastGood{state()}.file());
  EXPECT_EQ(configuration_notice(chosen),
            "octascope.toml:4: [scan] b_scans is 0, expected a whole number from 1 to 65536");
}

TEST_F(ConfigurationFiles, with_a_broken_calibration_give_way_too) {
  ASSERT_TRUE(keep());
  folder_.write("opt/calibration.toml", "[spectrometer]\nsamples = 64\n");
  const auto chosen = tests::must(choose());
  EXPECT_EQ(chosen.state, ConfigurationState::last_good);
  EXPECT_THAT(chosen.refusal, HasSubstr("samples is 64"));
}

TEST_F(ConfigurationFiles, of_which_none_is_good_leave_what_is_built_in_and_say_so) {
  fs::remove(own());
  const auto chosen = tests::must(choose());
  EXPECT_EQ(chosen.state, ConfigurationState::built_in);
  EXPECT_FALSE(chosen.configuration.plan);
  EXPECT_THAT(configuration_notice(chosen),
              testing::StartsWith("octascope.toml: cannot be opened"));
}

TEST_F(ConfigurationFiles, that_fail_later_give_way_one_after_the_other) {
  ASSERT_TRUE(keep());
  RunOptions options;
  options.configuration = own();
  const auto own_one = choose();
  const auto second = tests::must(next_choice(*own_one, "the camera refuses it", options, state()));
  EXPECT_EQ(second.state, ConfigurationState::last_good);
  const auto third = tests::must(next_choice(second, "and this one", options, state()));
  EXPECT_EQ(third.state, ConfigurationState::built_in);
  EXPECT_EQ(third.refusal, "the camera refuses it") << "why the file is not used";
  EXPECT_FALSE(next_choice(third, "nothing", options, state()));
}

TEST_F(ConfigurationFiles, that_are_broken_end_a_run_at_a_console) {
  write_configuration("b_scans = 0");
  RunOptions options;
  options.configuration = own();
  EXPECT_FALSE(choose_configuration(options, std::nullopt));
}

TEST_F(ConfigurationFiles, have_all_their_faults_told) {
  folder_.write("etc/octascope.toml", "[scan]\nb_scans = 0\n[display]\nwidht = 3\nopacity = 7\n");
  EXPECT_THAT(configuration_complaints(own()),
              ElementsAre(HasSubstr(":2: [scan] b_scans is 0"),
                          HasSubstr(":4: [display] unknown key \"widht\""),
                          HasSubstr(":5: [display] opacity")));
  write_configuration("b_scans = 20");
  fs::remove(folder_ / "etc/tables/k.txt");
  EXPECT_THAT(configuration_complaints(own()), ElementsAre(HasSubstr("k.txt")));
  folder_.write("etc/octascope.toml", "[sim]\nfaults = \"f.toml\"\ncontrols = \"c.toml\"\n"
                                      "[recordings]\nfolder = \"octascope.toml\"\n");
  EXPECT_THAT(configuration_complaints(own()),
              ElementsAre(HasSubstr(":2: found "), HasSubstr(":3: found "),
                          AllOf(HasSubstr("[recordings] folder is"), HasSubstr("is a file"))));
}

} // namespace
} // namespace octascope::firmware_host
