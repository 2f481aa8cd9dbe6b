#include <gtest/gtest.h>

#include "pipeline/files/config_document.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

std::string complaint(std::string_view text) {
  const auto document = ConfigDocument::parse(text, "test.toml");
  if (!document)
    return document.error().message;
  ConfigTable root = document->root();
  root.integer("count", 1, {0, 10});
  ConfigTable inner = root.table("inner");
  inner.number("level", 0.5, {0, 1});
  inner.choice("kind", 0, {"round", "square"});
  inner.numbers("list");
  for (ConfigTable& entry : root.tables("entry"))
    entry.text("name", "");
  const auto result = document->finish();
  return result ? "" : result.error().message;
}

TEST(ConfigDocument, accepts_what_is_asked_for) {
  EXPECT_EQ(complaint("count = 3\n[inner]\nlevel = 1\nkind = \"square\"\nlist = [1, 2.5]\n"
                      "[[entry]]\nname = \"a\"\n[[entry]]\n"),
            "");
}

TEST(ConfigDocument, refuses_with_place_found_and_expected) {
  EXPECT_EQ(complaint("count = 11"),
            "test.toml:1: count is 11, expected a whole number from 0 to 10");
  EXPECT_EQ(complaint("\ncount = 1.5"),
            "test.toml:2: count is 1.5, expected a whole number from 0 to 10");
  EXPECT_EQ(complaint("[inner]\nlevel = nan"),
            "test.toml:2: [inner] level is nan, expected a number from 0 to 1");
  EXPECT_EQ(complaint("[inner]\nkind = \"flat\""),
            "test.toml:2: [inner] kind is 'flat', expected one of \"round\", \"square\"");
  EXPECT_EQ(complaint("[inner]\nlist = [1, \"x\"]"),
            "test.toml:2: [inner] list[1] is 'x', expected a finite number");
}

TEST(ConfigDocument, reads_one_text_or_several) {
  const auto document =
      tests::must(ConfigDocument::parse("one = \"a\"\nmore = [\"b\", \"c\"]\nindex = 2\n", "c"));
  ConfigTable root = document.root();
  EXPECT_EQ(root.texts("one"), std::vector<std::string>{"a"});
  EXPECT_EQ(root.texts("more"), (std::vector<std::string>{"b", "c"}));
  EXPECT_EQ(root.texts("none"), std::vector<std::string>{});
  EXPECT_TRUE(root.has_integer("index"));
  EXPECT_FALSE(root.has_integer("one"));
  EXPECT_FALSE(root.has_integer("none"));
  root.integer("index", 0, {0, 9});
  EXPECT_TRUE(document.finish());
  for (const char* wrong : {"key = 3", "key = [\"a\", 3]"}) {
    const auto refused = tests::must(ConfigDocument::parse(wrong, "c"));
    EXPECT_TRUE(refused.root().texts("key").empty());
    EXPECT_FALSE(refused.finish()) << wrong;
  }
}

TEST(ConfigDocument, refuses_unknown_keys_anywhere) {
  EXPECT_EQ(complaint("[inner]\nlevl = 1"),
            "test.toml:2: [inner] unknown key \"levl\"; known here: kind, level, list");
  EXPECT_EQ(complaint("[[entry]]\nnme = \"a\""),
            "test.toml:2: [entry] unknown key \"nme\"; known here: name");
}

TEST(ConfigDocument, says_where_the_syntax_breaks) {
  EXPECT_NE(complaint("count = \n").find("test.toml:1:9: not TOML"), std::string::npos);
}

// The library had taken each of these for what cannot be.
TEST(ConfigDocument, tables_without_a_name_are_refused) {
  for (const char* header : {"[=]", "[/", "[[[", "[\\", "[\n", "[\x1b]"})
    EXPECT_NE(complaint(header).find("not TOML"), std::string::npos) << header;
}

TEST(ConfigDocument, letters_outside_of_quotes_are_refused) {
  for (const char* letter : {"é", "µ", "\u05c1", "\u0b4d", "\u2070", "\u2d7f", "\ufb50", "\xff"}) {
    EXPECT_NE(complaint(std::string{letter} + " = 1\n").find("not TOML"), std::string::npos);
    EXPECT_NE(complaint(std::string{"count = 1 "} + letter).find("not TOML"), std::string::npos);
    EXPECT_NE(complaint(std::string{"name = \"\"\"\\"} + letter + "\"\"\"\n").find("not TOML"),
              std::string::npos);
  }
}

TEST(ConfigDocument, missing_files_and_directories_are_named) {
  EXPECT_NE(ConfigDocument::load("/nowhere/x.toml").error().message.find("/nowhere/x.toml"),
            std::string::npos);
  EXPECT_NE(ConfigDocument::load("/tmp").error().message.find("is a directory"), std::string::npos);
}

} // namespace
} // namespace octascope::pipeline
