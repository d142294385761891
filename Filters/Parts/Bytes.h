// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values as bytes, to be sent from rank to rank. Private to the module.
 *
 * Plain values go as they are in memory. A struct with lists or texts goes field by field: its
 * FieldsOf lists them, once for both ways.
 *
 * The layout, in the byte order and with the padding of this machine:
 *
 *   plain value   | value |                        any type that can be copied bit by bit
 *   list, text    | count | value | value | ...    count is a std::size_t
 *   struct        | field | field | ...            in the order of its FieldsOf
 *   message       | count | text of Pack() |
 *   data set      | count | bytes of PackData() |  none where it is nullptr
 *
 * No byte says what comes next: the reader has to ask for the same types in the same order as the
 * writer gave them. Values need not be aligned, so they are copied and never viewed in place.
 */
#ifndef Bytes_h
#define Bytes_h

#include "Adapt/Adapt.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"

#include "vtkSmartPointer.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace elevation
{

/** Values of any kinds, one after another; all ranks have the same byte order. */
using Bytes = Buffer<char>;

template <typename Value>
void AppendTo(Bytes& bytes, const Value* values, std::size_t count)
{
  const std::size_t size = bytes.size(), all = size + count * sizeof(Value);
  // A Buffer grows to what it is asked for and no further: without the half on top, a series of
  // short appends would copy all bytes each time.
  if (all > bytes.capacity())
  {
    bytes.Reserve(std::max(all, size + size / 2));
  }
  bytes.Resize(all);
  std::copy_n(reinterpret_cast<const char*>(values), all - size, bytes.data() + size);
}

template <typename Value>
void AppendTo(Bytes& bytes, const std::vector<Value>& values)
{
  AppendTo(bytes, values.data(), values.size());
}

/** Takes values and moves on. Nobody checks that so many bytes are left. */
template <typename Value>
void TakeFrom(const char*& from, Value* values, std::size_t count)
{
  // An empty list may have a null pointer, which memcpy() must not get. The cast silences a warning
  // about plain structs whose members have initial values.
  if (count > 0)
  {
    std::memcpy(static_cast<void*>(values), from, count * sizeof(Value));
    from += count * sizeof(Value);
  }
}

/** Appends values to those that are there. */
template <typename Value>
void TakeFrom(const char*& from, std::size_t count, std::vector<Value>& values)
{
  values.resize(values.size() + count);
  TakeFrom(from, values.data() + values.size() - count, count);
}

/** The same with as many as fit into the bytes. */
template <typename Value>
void TakeAll(const Bytes& bytes, std::vector<Value>& values)
{
  const char* from = bytes.data();
  TakeFrom(from, bytes.size() / sizeof(Value), values);
}

/** A list or text of plain values with its length, so that it can be taken without knowing that. */
template <typename List>
void AppendList(Bytes& bytes, const List& values)
{
  const std::size_t count = values.size();
  AppendTo(bytes, &count, 1);
  AppendTo(bytes, values.data(), count);
}

template <typename List>
void TakeList(const char*& from, List& values)
{
  std::size_t count = 0;
  TakeFrom(from, &count, 1);
  values.resize(count);
  TakeFrom(from, values.data(), count);
}

/**
 * FieldsOf<Struct>::In(value) is a tuple of references to what there is in a struct. It is
 * specialised where the struct is packed. In() is a template, as it serves a constant value, which
 * is packed, and one that is being filled. A member that it leaves out keeps its initial value on
 * the other side.
 */
template <typename Struct>
struct FieldsOf;

/**
 * Packs and unpacks values of any kind: plain ones, texts, messages, data sets, structs with
 * FieldsOf, and lists of these. Each value marks its own end.
 */
struct AnyValue
{
  template <typename Value>
  static void Append(Bytes& bytes, const Value& value)
  {
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      AppendTo(bytes, &value, 1);
    }
    else
    {
      std::apply([&bytes](const auto&... fields) { (Append(bytes, fields), ...); },
        FieldsOf<Value>::In(value));
    }
  }
  template <typename Value>
  static void Append(Bytes& bytes, const std::vector<Value>& values)
  {
    // Plain values go in one copy; std::vector itself is never a plain value.
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      AppendList(bytes, values);
    }
    else
    {
      Append(bytes, values.size());
      std::for_each(
        values.begin(), values.end(), [&bytes](const Value& value) { Append(bytes, value); });
    }
  }
  /** A text, a message and a data set; the compiler prefers these to the template above. */
  static void Append(Bytes& bytes, const std::string& text) { AppendList(bytes, text); }
  static void Append(Bytes& bytes, const Message& message) { Append(bytes, message.Pack()); }
  static void Append(Bytes& bytes, const vtkSmartPointer<vtkPolyData>& data);

  template <typename Value>
  static void Take(const char*& from, Value& value)
  {
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      TakeFrom(from, &value, 1);
    }
    else
    {
      std::apply(
        [&from](auto&... fields) { (Take(from, fields), ...); }, FieldsOf<Value>::In(value));
    }
  }
  template <typename Value>
  static void Take(const char*& from, std::vector<Value>& values)
  {
    if constexpr (std::is_trivially_copyable_v<Value>)
    {
      TakeList(from, values);
    }
    else
    {
      std::size_t count = 0;
      Take(from, count);
      values.resize(count);
      std::for_each(values.begin(), values.end(), [&from](Value& value) { Take(from, value); });
    }
  }
  static void Take(const char*& from, std::string& text) { TakeList(from, text); }
  static void Take(const char*& from, Message& message)
  {
    std::string text;
    Take(from, text);
    message = Message::Unpack(text);
  }
  static void Take(const char*& from, vtkSmartPointer<vtkPolyData>& data);
};

/** A value as bytes of its own, and back. */
template <typename Value>
Bytes Packed(const Value& value)
{
  Bytes bytes;
  AnyValue::Append(bytes, value);
  return bytes;
}
template <typename Value>
Value Unpacked(const Bytes& bytes)
{
  Value value;
  const char* from = bytes.data();
  AnyValue::Take(from, value);
  return value;
}

} // namespace elevation

#endif
