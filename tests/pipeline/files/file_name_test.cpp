#include <filesystem>

#include <gtest/gtest.h>

#include "pipeline/files/file_name.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::pipeline {
namespace {

namespace fs = std::filesystem;

TEST(FileName, has_an_ending_in_small_letters) {
  EXPECT_EQ(file_ending("a/PICTURE.PnG"), ".png");
  EXPECT_EQ(file_ending("tree.SWC"), ".swc");
  EXPECT_EQ(file_ending("none"), "");
  EXPECT_EQ(file_ending("folder.d/none"), "");
}

TEST(FileName, leads_to_the_same_file_by_links_hard_links_and_linked_folders) {
  const tests::ScratchFolder folder;
  folder.write("a", "a");
  folder.write("b", "a");
  fs::create_directory(folder / "sub");
  folder.write("sub/c", "c");
  fs::create_symlink(folder / "a", folder / "link");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_symlink(folder / "sub", folder / "linked");
  for (const char* const other : {"a", "link", "hard", "sub/../a", "./a"})
    EXPECT_TRUE(is_same_file(folder / "a", folder / other)) << other;
  EXPECT_TRUE(is_same_file(folder / "sub/c", folder / "linked/c"));
  EXPECT_TRUE(is_same_file(folder / "sub/new", folder / "linked/new")) << "not there yet";
  EXPECT_FALSE(is_same_file(folder / "a", folder / "b"));
  EXPECT_FALSE(is_same_file(folder / "a", folder / "new"));
}

} // namespace
} // namespace octascope::pipeline
