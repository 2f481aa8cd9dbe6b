// The local socket: who may ask, what he gets, and that nobody can hold it.
#include <array>
#include <cstring>
#include <list>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "firmware-host/supervision/status_server.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

using hal::linux_backend::FileDescriptor;
using testing::HasSubstr;
using tests::ScratchFolder;

FileDescriptor connect_to(const std::filesystem::path& path) {
  FileDescriptor file{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  EXPECT_EQ(::connect(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return file;
}

TEST(StatusServer, answers_everybody_anew) {
  const ScratchFolder folder;
  int asked = 0;
  const auto server = StatusServer::start(
      folder / "status.sock", [&asked] { return "answer " + std::to_string(++asked) + "\n"; });
  ASSERT_TRUE(server) << server.error().message;
  EXPECT_EQ(ask_status(folder / "status.sock").value_or(""), "answer 1\n");
  EXPECT_EQ(ask_status(folder / "status.sock").value_or(""), "answer 2\n");
}

TEST(StatusServer, sends_answers_that_no_buffer_holds) {
  const ScratchFolder folder;
  const std::string answer(3'000'000, 'x');
  const auto server = StatusServer::start(folder / "status.sock", [&] { return answer; });
  ASSERT_TRUE(server);
  EXPECT_TRUE(ask_status(folder / "status.sock").value_or("") == answer);
}

TEST(StatusServer, is_for_owner_and_group_alone) {
  const ScratchFolder folder;
  const auto server = StatusServer::start(folder / "status.sock", [] { return ""; });
  ASSERT_TRUE(server);
  struct stat found {};
  ASSERT_EQ(::stat((folder / "status.sock").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0660U);
}

TEST(StatusServer, cannot_be_held_by_clients_that_do_not_read) {
  const ScratchFolder folder;
  const std::string answer(500'000, 'x'); // more than a socket holds
  const auto server = StatusServer::start(folder / "status.sock", [&] { return answer; });
  ASSERT_TRUE(server);
  std::list<FileDescriptor> silent;
  for (int i = 0; i < 20; ++i)
    silent.push_back(connect_to(folder / "status.sock"));
  EXPECT_TRUE(ask_status(folder / "status.sock").value_or("") == answer);
}

TEST(StatusServer, outlives_clients_that_hang_up) {
  const ScratchFolder folder;
  const std::string answer(500'000, 'x'); // more than a socket holds
  const auto server = StatusServer::start(folder / "status.sock", [&] { return answer; });
  ASSERT_TRUE(server);
  for (int i = 0; i < 50; ++i)
    connect_to(folder / "status.sock");
  EXPECT_TRUE(ask_status(folder / "status.sock").value_or("") == answer);
}

TEST(StatusServer, replaces_what_an_ended_program_left_and_takes_its_own_away) {
  const ScratchFolder folder;
  folder.write("status.sock", "left");
  {
    const auto server = StatusServer::start(folder / "status.sock", [] { return "new"; });
    ASSERT_TRUE(server) << server.error().message;
    const auto second = StatusServer::start(folder / "status.sock", [] { return "second"; });
    ASSERT_FALSE(second) << "one appliance, one socket";
    EXPECT_EQ(second.error().code, hal::ErrorCode::busy);
    EXPECT_EQ(ask_status(folder / "status.sock").value_or(""), "new");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "status.sock"));
}

TEST(StatusServer, is_missed_with_words_that_help) {
  const ScratchFolder folder;
  const auto nobody = tests::error_of(ask_status(folder / "status.sock"));
  EXPECT_EQ(nobody.code, hal::ErrorCode::absent);
  EXPECT_THAT(nobody.message, HasSubstr("systemctl status octascope"));
  EXPECT_THAT(ask_status(folder / std::string(200, 'x')),
              tests::FailsWith(hal::ErrorCode::invalid_argument));
}

} // namespace
} // namespace octascope::firmware_host
