// The bounds of YAML text, whatever it is the text of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "mapper/io/config.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

std::string YamlRefusal(const std::string& text) {
  return RefusalOf([&] { Config::FromText(text, "x"); });
}

std::string SetRefusal(const std::string& assignment) {
  Config config;
  return RefusalOf([&] { config.Set(assignment); });
}

std::string Repeated(const std::string& text, int times) {
  std::string whole;
  for (int i = 0; i < times; ++i) whole += text;
  return whole;
}

TEST(YamlText, AliasesAreRefused) {
  const std::string rule = "an alias (*name) is not read, write the value itself";
  EXPECT_EQ(YamlRefusal("seed: 1\nscene: &a [*a]\n"), "x:2: " + rule);
  EXPECT_EQ(YamlRefusal("a: &a 1\nb: *a\n"), "x:2: " + rule);
  EXPECT_EQ(YamlRefusal("a: &a {b: 1}\nc:\n  <<: *a\n"), "x:3: " + rule);
  EXPECT_EQ(SetRefusal("scene=&a [*a]"), "--set scene=&a [*a]:1: " + rule);
  EXPECT_EQ(YamlRefusal("a: &a 1\n"), "no error");
  EXPECT_THAT(YamlRefusal("a: *b\n"), HasSubstr("x:1: not valid YAML"));
}

TEST(YamlText, AFewLinesOfAliasesAreNoBomb) {
  std::string text = "a0: &a0 [x]\n";
  for (int i = 1; i < 40; ++i) {
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" +
            Repeated("*a" + std::to_string(i - 1) + ", ", 9) + "]\n";
  }
  EXPECT_THAT(YamlRefusal(text), HasSubstr("x:2: an alias"));
}

TEST(YamlText, DeepNestingIsRefused) {
  const auto nested = [](int depth) { return Repeated("[", depth) + "1" + Repeated("]", depth); };
  EXPECT_EQ(YamlRefusal("a: " + nested(99)), "no error");
  EXPECT_EQ(YamlRefusal("a: " + nested(100)), "x:1: values are nested deeper than 100");
  EXPECT_EQ(YamlRefusal("a: " + nested(100000)), "x:1: values are nested deeper than 100");
  EXPECT_EQ(YamlRefusal(Repeated("{a: ", 500) + "1" + Repeated("}", 500)),
            "x:1: values are nested deeper than 100");
  // What is never closed may be taken for a key before its depth is seen.
  EXPECT_NE(YamlRefusal("a: " + Repeated("[", 100000)), "no error");
  EXPECT_NE(YamlRefusal(Repeated("{a: ", 100000)), "no error");
  EXPECT_THAT(YamlRefusal(Repeated("- ", 100000)), HasSubstr("nested deeper than 100"));
  EXPECT_THAT(SetRefusal("a=" + nested(101)), HasSubstr("nested deeper than 100"));
  EXPECT_EQ(SetRefusal(Repeated("a.", 99) + "a=1"), "no error");
  EXPECT_THAT(SetRefusal(Repeated("a.", 100000) + "a=1"), HasSubstr("nested deeper than 100"));
}

TEST(YamlText, MoreThanAMillionValuesAreRefused) {
  EXPECT_EQ(YamlRefusal("a: [" + Repeated("1,", 1000) + "1]"), "no error");
  EXPECT_EQ(YamlRefusal("a: [" + Repeated("1,", 1000001) + "1]"), "x:1: more than 1000000 values");
}

TEST(YamlText, ManyKeysAreComparedInReasonableTime) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "key_" + std::to_string(i) + ": 1\n";
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(YamlRefusal(text), "no error");
  EXPECT_EQ(YamlRefusal(text + "key_7: 2\n"), "x:100001: key 'key_7' is given twice");
  // Each with each would be minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

// A list that is never closed is no key.
TEST(YamlText, WhatIsNotYamlIsSaidOfTheValue) {
  EXPECT_EQ(SetRefusal("seed=[1"), "--set seed=[1: the value is not valid YAML: '[' is not closed");
  EXPECT_EQ(SetRefusal("slam={loops: {recall"),
            "--set slam={loops: {recall: the value is not valid YAML: '{' is not closed");
  EXPECT_EQ(SetRefusal("scene=\"a"),
            "--set scene=\"a: the value is not valid YAML: illegal EOF in scalar");
  EXPECT_EQ(YamlRefusal("[1"), "x:1: not valid YAML: '[' is not closed");
}

// The parser notices at the next bracket or at the end of the text, lines later.
TEST(YamlText, ABracketIsNotClosedWhereItIsOpened) {
  EXPECT_EQ(YamlRefusal("a: 1\nb: [1, 2\nc: 3\n"), "x:2: not valid YAML: '[' is not closed");
  EXPECT_EQ(YamlRefusal("a: 1\nb: [1, 2\n"), "x:2: not valid YAML: '[' is not closed");
  EXPECT_EQ(YamlRefusal("a: 1\nb: {c: 1, d: 2\n\nx: 1\n"),
            "x:2: not valid YAML: '{' is not closed");
  EXPECT_EQ(YamlRefusal("a: [1,\n [2, 3],\n {b: 2,\n  c: [3]\n"),
            "x:3: not valid YAML: '{' is not closed");
}

TEST(YamlText, KeysArePlainWordsGivenOnce) {
  EXPECT_EQ(YamlRefusal("a: 1\n[b]: 2\n"), "x:2: a key must be a plain word");
  EXPECT_EQ(YamlRefusal("a: 1\n? {b: 1}\n: 2\n"), "x:2: a key must be a plain word");
  EXPECT_EQ(YamlRefusal("a: [{b: 1},\n {b: 1, b: 2}]\n"), "x:2: key 'b' is given twice");
  EXPECT_EQ(YamlRefusal("a: {b: 1}\nb: {b: 1}\n"), "no error");
  EXPECT_THAT(SetRefusal("a={b: 1, b: 2}"), HasSubstr("key 'b' is given twice"));
}

}  // namespace
}  // namespace depthgrid
