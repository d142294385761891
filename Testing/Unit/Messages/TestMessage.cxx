// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
// A message is a code with values by their names, and the sentence that they make.
#include "Kernel/Messages/Messages.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace elevation;

namespace
{
using Values = std::vector<Message::Value>;

constexpr Sentence Plain{ "Plain", "{count} points at {x} of {count}." };
constexpr Sentence Named{ "Named",
  "{property:Spacing} is {value}; a {property:Spacing} of 2 would do." };
constexpr Sentence Outer{ "Outer", "Hole {hole}: {reason} It stays." };
constexpr Sentence Nothing{ "Nothing", "" };

// A warning is a Message, and the only way to make one is by its code.
static_assert(!std::is_constructible_v<Message, std::string>);
static_assert(!std::is_constructible_v<Message, const char*>);
static_assert(!std::is_constructible_v<Message, Sentence, Values>);

TEST(Message, TakesAValueForEachPlaceAndNoneForProperties)
{
  static_assert(CountValues(Plain.Text) == 2);
  static_assert(CountValues(Named.Text) == 1);
  static_assert(CountValues(Nothing.Text) == 0);
}

TEST(Message, NamesItsValuesAsTheTextDoes)
{
  const Message message = MakeMessage<Plain>(12, 0.5);
  EXPECT_EQ(message.GetCode(), "Plain");
  EXPECT_EQ(message.GetValues(), (Values{ { "count", "12" }, { "x", "0.5" } }));
  EXPECT_EQ(message.Words(), "12 points at 0.5 of 12.");
}

TEST(Message, NamesPropertiesAsTheFiltersDo)
{
  const Message message = MakeMessage<Named>(ToText(1.0 / 3.0, 3));
  EXPECT_EQ(message.Words(), "Spacing is 0.333; a Spacing of 2 would do.");
  EXPECT_EQ(message.GetText(), Named.Text);
}

TEST(Message, OfAValueIsNotReadAsAText)
{
  EXPECT_EQ(MakeMessage<Named>("{value} {property:X} }{").Words(),
    "Spacing is {value} {property:X} }{; a Spacing of 2 would do.");
}

TEST(Message, OfAnotherOneHasItsValuesToo)
{
  const Message message = MakeMessage<Outer>(3, MakeMessage<Named>("{0}"));
  EXPECT_EQ(message.Words(), "Hole 3: Spacing is {0}; a Spacing of 2 would do. It stays.");
  EXPECT_EQ(message.GetValues(),
    (Values{ { "hole", "3" }, { "reason", "Named" }, { "reason_value", "{0}" } }));
  EXPECT_EQ(MakeMessage<Outer>(3, Message()).Words(), "Hole 3:  It stays.");
}

TEST(Message, BeginsWithItsBlock)
{
  Message message = MakeMessage<Plain>(1, 2);
  message.SetBlock("Block 3 (\"{x}\")");
  EXPECT_EQ(message.Words(), "Block 3 (\"{x}\"): 1 points at 2 of 1.");
}

TEST(Message, IsTheSameOnAnotherRank)
{
  Message message = MakeMessage<Outer>(3, MakeMessage<Plain>("", "two\nlines"));
  for (const char* const block : { "", "Block 1" })
  {
    message.SetBlock(block);
    const Message other = Message::Unpack(message.Pack());
    EXPECT_EQ(other, message);
    EXPECT_EQ(other.Words(), message.Words());
    EXPECT_EQ(other.GetValues(), message.GetValues());
  }
}

TEST(Message, OfAnErrorIsWhatItWasMadeOf)
{
  const CodedError error = MakeError<Plain>(1, 2);
  EXPECT_STREQ(error.what(), "1 points at 2 of 1.");
  const Error& caught = error;
  EXPECT_EQ(MessageOf(caught), error.AsMessage());
  EXPECT_EQ(MessageOf(std::bad_alloc()), MakeMessage<sentences::NotEnoughMemory>());
  const Message words = MessageOf(Error("Array \"{x}\" is wrong."));
  EXPECT_EQ(words.Words(), "Array \"{x}\" is wrong.");
  EXPECT_EQ(words.GetValues(), (Values{ { "words", "Array \"{x}\" is wrong." } }));
}

TEST(Message, IsEmptyWithoutACode)
{
  EXPECT_TRUE(Message().IsEmpty());
  EXPECT_FALSE(MakeMessage<Nothing>().IsEmpty());
}
} // namespace
