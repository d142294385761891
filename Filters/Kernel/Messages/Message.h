// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * One warning or error: data for programs, from which the sentence for people is made.
 *
 * A Sentence (Sentences.h) is a code with a text that has places for values, {points}, and for
 * names of properties, {property:Spacing}. A Message has the values too. So a program need not read
 * English: it looks for the code, takes the values by their names, or makes the sentence with other
 * names of properties. Guarantee: the compiler refuses a message without a code, and one with more
 * or fewer values than its text has places. Only an Error may be made of words alone.
 */
#ifndef elevation_Messages_Message_h
#define elevation_Messages_Message_h

#include "Kernel/Base/Base.h"

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * A code, and the text of its messages.
 *
 * An example, with the values of its Message:
 *   Code    InvalidThreads
 *   Text    {property:NumberOfThreads} is {value}; it must be 0 (those of VTK) to {most}.
 *   Values  value = -1, most = 256
 */
struct Sentence
{
  const char* Code;
  const char* Text;
};

/**
 * How many values a text has places for. One that comes again counts once; properties do not. At
 * compile time, see MakeMessage().
 */
constexpr std::size_t CountValues(std::string_view text)
{
  std::size_t count = 0;
  for (std::size_t begin = text.find('{'); begin < text.size(); begin = text.find('{', begin + 1))
  {
    const std::string_view place = text.substr(begin, text.find('}', begin) + 1 - begin);
    count += place.find(':') == place.npos && text.find(place) == begin ? 1 : 0;
  }
  return count;
}

/** A number in words, of so many digits. */
std::string ToText(double value, int digits = 6);

class Message
{
public:
  /** A value by its name. */
  using Value = std::pair<std::string, std::string>;
  class Argument;

  /** None. */
  Message() = default;

  bool IsEmpty() const { return this->Code.empty(); }
  const std::string& GetCode() const { return this->Code; }
  const std::string& GetText() const { return this->Text; }
  const std::vector<Value>& GetValues() const { return this->Values; }

  /** The sentence, after the name of the block. */
  std::string Words() const;

  ///@{
  /** The block of a composite input that it is about; empty: it is about all. */
  const std::string& GetBlock() const { return this->Block; }
  void SetBlock(const std::string& name) { this->Block = name; }
  ///@}

  ///@{
  /** As bytes, for another rank. */
  std::string Pack() const;
  static Message Unpack(const std::string& bytes);
  ///@}

  // All that a message has is in its bytes.
  bool operator==(const Message& other) const { return this->Pack() == other.Pack(); }

private:
  Message(const Sentence& sentence, const std::vector<Argument>& values);

  template <const Sentence& sentence, typename... Values>
  friend Message MakeMessage(const Values&... values);
  friend Message MessageOf(const std::exception& failure);

  std::string Code, Text, Block;
  std::vector<Value> Values;
};

/**
 * What a place is filled with: a number, a text, or another message. One type for all kinds of
 * values, so that MakeMessage() passes them as one list.
 */
class Message::Argument
{
public:
  Argument(std::string text)
    : Text(std::move(text))
  {
  }
  Argument(const char* text)
    : Text(text)
  {
  }
  Argument(double value)
    : Text(ToText(value))
  {
  }
  template <typename Integer, typename = std::enable_if_t<std::is_integral_v<Integer>>>
  Argument(Integer value)
    : Text(std::to_string(value))
  {
  }
  Argument(Message inner)
    : Text(inner.Code)
    , Inner(std::move(inner))
  {
  }

  std::string Text; ///< of a message its code
  Message Inner;
};

/**
 * The message of a sentence.
 * @param[in] values  in the order in which the text first names them. Another message may be one:
 *                    its text takes the place, and its values are named {place}_{name}.
 */
template <const Sentence& sentence, typename... Values>
Message MakeMessage(const Values&... values)
{
  static_assert(CountValues(sentence.Text) == sizeof...(Values), "a value for each place");
  return Message(sentence, { Message::Argument(values)... });
}

/**
 * An Error as data. For programs that catch it; elsewhere it is an Error with its sentence.
 */
class CodedError : public Error
{
public:
  explicit CodedError(Message message)
    : Error(message.Words())
    , What(std::move(message))
  {
  }
  const Message& AsMessage() const { return this->What; }

private:
  Message What;
};

/** The error of a sentence, as MakeMessage(). */
template <const Sentence& sentence, typename... Values>
CodedError MakeError(const Values&... values)
{
  return CodedError(MakeMessage<sentence>(values...));
}

/** What is reported of a failure. */
Message MessageOf(const std::exception& failure);

} // namespace elevation

#endif
