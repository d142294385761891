// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Message.h"

#include "Sentences.h"

#include <algorithm>
#include <iomanip>
#include <new>
#include <sstream>

namespace elevation
{

namespace
{
/**
 * A text with its places filled.
 * @param[in] fill  makes of what stands in braces what takes its place
 */
template <typename Fill>
std::string Filled(std::string_view text, Fill&& fill)
{
  std::string filled;
  // Texts are our own, so every brace has its counterpart.
  for (std::size_t end = 0; end < text.size();)
  {
    const std::size_t begin = std::min(text.find('{', end), text.size());
    filled += text.substr(end, begin - end);
    end = begin;
    if (begin < text.size())
    {
      end = text.find('}', begin) + 1;
      filled += fill(text.substr(begin + 1, end - begin - 2));
    }
  }
  return filled;
}

/** The name of a property; empty: the place is that of a value. */
std::string_view PropertyOf(std::string_view place)
{
  const std::size_t colon = place.find(':');
  return colon == place.npos ? std::string_view() : place.substr(colon + 1);
}

std::string InBraces(std::string_view place)
{
  return "{" + std::string(place) + "}";
}
} // namespace

std::string ToText(double value, int digits)
{
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

Message::Message(const Sentence& sentence, const std::vector<Argument>& values)
  : Code(sentence.Code)
{
  auto next = values.begin();
  std::vector<std::string> places; // of the values
  // Places of values stay in the text, also those of a message inside, under longer names; a place
  // that comes again has its value already.
  this->Text = Filled(sentence.Text, [&](std::string_view place) {
    if (!PropertyOf(place).empty())
    {
      return InBraces(place);
    }
    const std::string name(place);
    // Values come in the order of places; a place that comes again takes the value it had.
    auto at = std::find(places.begin(), places.end(), name);
    const bool isNew = at == places.end();
    const Argument& value = isNew ? *next++ : values[at - places.begin()];
    const Message& inner = value.Inner;
    if (isNew)
    {
      places.push_back(name);
      this->Values.emplace_back(name, value.Text);
      for (const Value& one : inner.Values)
      {
        this->Values.emplace_back(name + "_" + one.first, one.second);
      }
    }
    return inner.IsEmpty() ? InBraces(place) : Filled(inner.Text, [&](std::string_view of) {
      return PropertyOf(of).empty() ? InBraces(name + "_" + std::string(of)) : InBraces(of);
    });
  });
}

std::string Message::Words() const
{
  return (this->Block.empty() ? "" : this->Block + ": ") +
    // The name of a property stands for itself; Python puts its own names there.
    Filled(this->Text, [this](std::string_view place) {
      const auto value = std::find_if(this->Values.begin(), this->Values.end(),
        [place](const Value& one) { return one.first == place; });
      return value == this->Values.end() ? std::string(PropertyOf(place)) : value->second;
    });
}

// Texts one after another, each with a zero at its end, which no text contains.
std::string Message::Pack() const
{
  std::string bytes;
  const auto add = [&bytes](const std::string& text) { bytes.append(text).push_back('\0'); };
  add(this->Code);
  add(this->Text);
  add(this->Block);
  for (const Value& value : this->Values)
  {
    add(value.first);
    add(value.second);
  }
  return bytes;
}

Message Message::Unpack(const std::string& bytes)
{
  std::vector<std::string> texts;
  for (std::size_t begin = 0, end = 0; begin < bytes.size(); begin = end + 1)
  {
    end = bytes.find('\0', begin);
    texts.push_back(bytes.substr(begin, end - begin));
  }
  Message message;
  message.Code = texts[0];
  message.Text = texts[1];
  message.Block = texts[2];
  for (std::size_t i = 3; i + 1 < texts.size(); i += 2)
  {
    message.Values.emplace_back(texts[i], texts[i + 1]);
  }
  return message;
}

Message MessageOf(const std::exception& failure)
{
  if (auto* const error = dynamic_cast<const CodedError*>(&failure))
  {
    return error->AsMessage();
  }
  // For errors that were made of words alone.
  static constexpr Sentence words{ "Words", "{words}" };
  return dynamic_cast<const std::bad_alloc*>(&failure) ? MakeMessage<sentences::NotEnoughMemory>()
                                                       : Message(words, { failure.what() });
}

} // namespace elevation
