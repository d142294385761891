// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values as bytes, to be sent from rank to rank. Private to the module.
 */
#ifndef Bytes_h
#define Bytes_h

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace elevation
{

/** Values of any kinds, one after another; all ranks have the same byte order. */
using Bytes = Buffer<char>;

template <typename Value>
void AppendTo(Bytes& bytes, const Value* values, std::size_t count)
{
  const std::size_t size = bytes.size(), all = size + count * sizeof(Value);
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

/** Takes values and moves on. */
template <typename Value>
void TakeFrom(const char*& from, Value* values, std::size_t count)
{
  if (count > 0)
  {
    std::memcpy(static_cast<void*>(values), from, count * sizeof(Value));
    from += count * sizeof(Value);
  }
}

template <typename Value>
void TakeFrom(const char*& from, std::size_t count, std::vector<Value>& values)
{
  values.resize(count);
  TakeFrom(from, values.data(), count);
}

/** A list with its length, so that it can be taken without knowing that. */
template <typename Value>
void AppendList(Bytes& bytes, const std::vector<Value>& values)
{
  const std::size_t count = values.size();
  AppendTo(bytes, &count, 1);
  AppendTo(bytes, values);
}

template <typename Value>
void TakeList(const char*& from, std::vector<Value>& values)
{
  std::size_t count = 0;
  TakeFrom(from, &count, 1);
  TakeFrom(from, count, values);
}

} // namespace elevation

#endif
