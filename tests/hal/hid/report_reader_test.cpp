// Raw devices through hidapi: reports reach whoever waits, in order and all of them, and hidapi's
// thread rules are kept.
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <poll.h>

#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/hid/raw/raw_device.h"
#include "hal/linux/hid/raw/report_reader.h"
#include "tests/hal/hid/fake_hidapi.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::hal::linux_backend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::FailsWith;
using Report = std::vector<std::uint8_t>;

class RawDevices : public testing::Test {
protected:
  std::string plug(const std::string& name) {
    std::string node = (folder_.path() / name).string();
    std::ofstream{node} << "a node";
    hidapi_.plug(node, 0x05f3, 0x00ff);
    return node;
  }
  static bool has_news(const ReportReader& reader, int timeout_ms = 5000) {
    pollfd waiting{reader.descriptor(), POLLIN, 0};
    return ::poll(&waiting, 1, timeout_ms) > 0;
  }
  // The next report, waited for; empty: none came in time.
  static Report next(ReportReader& reader) {
    while (true) {
      const auto report = reader.take();
      EXPECT_TRUE(report) << report.error().message;
      if (!report)
        return {};
      if (!report->empty())
        return {report->begin(), report->end()};
      if (!has_news(reader))
        return {};
    }
  }

  tests::ScratchFolder folder_;
  tests::FakeHidapi hidapi_;
};

class ReportReaderTest : public RawDevices {
protected:
  void SetUp() override {
    auto device = RawDevice::open(node_);
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::move(*device);
    auto reader = ReportReader::start(*device_);
    ASSERT_TRUE(reader) << reader.error().message;
    reader_ = std::move(*reader);
  }

  const std::string node_ = plug("hidraw0");
  std::unique_ptr<RawDevice> device_;
  std::unique_ptr<ReportReader> reader_; // goes first
};

TEST_F(ReportReaderTest, a_report_wakes_whoever_waits) {
  EXPECT_TRUE(reader_->take()->empty());
  EXPECT_FALSE(has_news(*reader_, 0));
  hidapi_.send(node_, {1, 2, 3});
  EXPECT_TRUE(has_news(*reader_));
  EXPECT_EQ(next(*reader_), (Report{1, 2, 3}));
  EXPECT_TRUE(reader_->take()->empty());
  EXPECT_FALSE(has_news(*reader_, 0)) << "it is told once";
}

TEST_F(ReportReaderTest, many_come_in_order_and_none_is_lost) {
  constexpr int many = 20 * static_cast<int>(ReportReader::most_reports);
  std::thread sender{[&] {
    for (int i = 0; i < many; ++i)
      hidapi_.send(node_,
                   Report(static_cast<std::size_t>(1 + i % 7), static_cast<std::uint8_t>(i)));
  }};
  for (int i = 0; i < many; ++i)
    ASSERT_EQ(next(*reader_),
              Report(static_cast<std::size_t>(1 + i % 7), static_cast<std::uint8_t>(i)));
  sender.join();
}

TEST_F(ReportReaderTest, what_was_sent_before_the_end_comes_first) {
  for (std::uint8_t i = 1; i <= 3; ++i)
    hidapi_.send(node_, {i});
  hidapi_.pull(node_);
  for (std::uint8_t i = 1; i <= 3; ++i)
    EXPECT_EQ(next(*reader_), Report{i});
  while (reader_->take())
    ASSERT_TRUE(has_news(*reader_));
  for (int again = 0; again < 2; ++again) {
    EXPECT_THAT(reader_->take(), FailsWith(ErrorCode::disconnected, node_));
    EXPECT_TRUE(has_news(*reader_, 0)) << "nobody waits for it in vain";
  }
}

TEST_F(ReportReaderTest, a_call_that_is_broken_off_is_made_again) {
  hidapi_.break_off_reading(node_, 2);
  hidapi_.send(node_, {7});
  EXPECT_EQ(next(*reader_), Report{7});
}

TEST_F(ReportReaderTest, ends_while_it_waits_for_room) {
  for (std::size_t i = 0; i < 3 * ReportReader::most_reports; ++i)
    hidapi_.send(node_, {1});
  EXPECT_TRUE(has_news(*reader_));
  reader_.reset();
  device_.reset();
  EXPECT_EQ(hidapi_.open_devices(), 0);
}

TEST_F(RawDevices, one_that_is_not_there_is_absent) {
  EXPECT_THAT(RawDevice::open((folder_.path() / "hidraw7").string()), FailsWith(ErrorCode::absent));
  EXPECT_EQ(hidapi_.begun(), 0);
}

TEST_F(RawDevices, where_hidapi_alone_refuses_its_words_are_told) {
  const std::string node = plug("hidraw0");
  hidapi_.refuse_to_open(true);
  EXPECT_THAT(RawDevice::open(node), FailsWith(ErrorCode::system, node, "no reason at all"));
}

TEST_F(RawDevices, are_listed_once_each_in_the_order_of_their_numbers) {
  hidapi_.plug("/dev/hidraw10", 1, 2);
  hidapi_.plug("/dev/hidraw9", 3, 4, 3);
  EXPECT_THAT(list_raw_nodes(),
              ElementsAre(RawNode{"/dev/hidraw9", 3, 4}, RawNode{"/dev/hidraw10", 1, 2}));
  EXPECT_EQ(hidapi_.begun(), 0) << "the last user ends hidapi";
}

// The sanitizer sees to hidapi's last error; the counts are seen everywhere.
TEST_F(RawDevices, are_opened_and_listed_by_several_threads_at_once) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([this, node = plug("hidraw" + std::to_string(i))] {
      for (int times = 0; times < 50; ++times) {
        const auto device = RawDevice::open(node);
        ASSERT_TRUE(device);
        EXPECT_EQ(hidapi_.begun(), 1);
        EXPECT_FALSE(list_raw_nodes().empty());
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(hidapi_.begun(), 0);
  EXPECT_EQ(hidapi_.open_devices(), 0);
}

// The lamp is written while nobody reads: a device's calls are those of one thread at a time.
TEST_F(RawDevices, a_lamp_is_lit_while_its_control_is_listened_to) {
  const std::string node = plug("hidraw0");
  HidNode found;
  found.node = node;
  ControlModel model;
  model.family = HidFamily::space_mouse;
  model.switches = 2;
  auto port = ControlPort::open(found, model);
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_THAT(hidapi_.written(node), ElementsAre());
  ASSERT_TRUE((*port)->start());
  EXPECT_THAT(hidapi_.written(node), ElementsAre(Report{4, 1}));

  hidapi_.send(node, {3, 2, 0});
  pollfd waiting{(*port)->descriptor(), POLLIN, 0};
  ASSERT_EQ(::poll(&waiting, 1, 5000), 1);
  std::optional<HidReading> reading;
  EXPECT_TRUE((*port)->read(reading).value());
  EXPECT_EQ(reading, HidReading{.switches = 2});
  EXPECT_FALSE((*port)->read(reading).value());

  (*port)->finish();
  port->reset();
  EXPECT_THAT(hidapi_.written(node), ElementsAre(Report{4, 1}, Report{4, 0}));
}

} // namespace
} // namespace octascope::hal::linux_backend
