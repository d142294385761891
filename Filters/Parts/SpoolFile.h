// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Bytes that do not fit into memory. Private to the module.
 */
#ifndef SpoolFile_h
#define SpoolFile_h

#include "Bytes.h"

#include <functional>
#include <string>

namespace elevation
{

/**
 * A file that is written stretch by stretch, and read like that. It goes with its object. There is
 * no file before the first stretch, and it is open only while it is written or read: a rank may
 * have some boxes for each of a thousand parts, more than a process may have open files.
 *
 *   | size | bytes ... | size | bytes ... | ...      size is a std::size_t; no stretch is empty
 *
 * The number of stretches stays in memory. So a file that has been cut off is noticed when it is
 * read.
 */
class SpoolFile
{
public:
  /** Takes the place of a file of this name. */
  explicit SpoolFile(const std::string& path);
  SpoolFile(SpoolFile&& other) noexcept;
  ~SpoolFile();

  /** @throws Error, as where the disk is full */
  void Append(const void* stretch, std::size_t size);

  bool IsEmpty() const { return this->Count == 0; }

  /** Hands over the stretches in their order. @throws Error if the file is not as it was written */
  void ForEach(const std::function<void(Bytes&&)>& visit) const;

  /** From here on there are no stretches. */
  void Remove();

private:
  std::string Path;
  bool IsThere = false;
  std::size_t Count = 0; // of stretches
};

} // namespace elevation

#endif
