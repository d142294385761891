// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SpoolFile.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

namespace elevation
{

namespace
{
struct Closer
{
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, Closer>;

// A read that ends early sets no errno. That is why Open() clears it.
Error Failed(const char* what, const std::string& path)
{
  const std::string reason = errno != 0 ? std::strerror(errno) : "the file is cut off";
  return Error(std::string("The temporary file ") + path + " cannot be " + what + ": " + reason);
}

OpenFile Open(const std::string& path, const char* mode, const char* what)
{
  errno = 0;
  OpenFile file(std::fopen(path.c_str(), mode));
  if (!file)
  {
    throw Failed(what, path);
  }
  return file;
}
} // namespace

SpoolFile::SpoolFile(const std::string& path)
  : Path(path)
{
}

SpoolFile::SpoolFile(SpoolFile&& other) noexcept
  : Path(std::move(other.Path))
  // The other must not remove the file when it goes.
  , IsThere(std::exchange(other.IsThere, false))
  , Count(std::exchange(other.Count, 0))
{
}

SpoolFile::~SpoolFile()
{
  this->Remove();
}

void SpoolFile::Append(const void* stretch, std::size_t size)
{
  // The first stretch also replaces a file that an earlier run has left behind.
  OpenFile file = Open(this->Path, this->Count > 0 ? "ab" : "wb", "written");
  // Also where writing fails next: what has been written goes with the object.
  this->IsThere = true;
  const bool isWritten = std::fwrite(&size, sizeof(size), 1, file.get()) == 1 &&
    std::fwrite(stretch, 1, size, file.get()) == size;
  // On a full disk the first call to fail may be fclose(), which writes what is still buffered.
  if (!isWritten || std::fclose(file.release()) != 0)
  {
    throw Failed("written", this->Path);
  }
  ++this->Count;
}

void SpoolFile::ForEach(const std::function<void(Bytes&&)>& visit) const
{
  const OpenFile file = this->IsEmpty() ? OpenFile() : Open(this->Path, "rb", "read");
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    // A size of 0, or no size, leaves the stretch empty: then the file is not as it was written.
    std::size_t size = 0;
    Bytes stretch;
    if (std::fread(&size, sizeof(size), 1, file.get()) == 1)
    {
      stretch.Resize(size);
    }
    if (stretch.empty() || std::fread(stretch.data(), 1, size, file.get()) != size)
    {
      throw Failed("read", this->Path);
    }
    visit(std::move(stretch));
  }
}

void SpoolFile::Remove()
{
  // Only what this object has made: a file of this name may be anybody's.
  if (this->IsThere)
  {
    std::remove(this->Path.c_str());
  }
  this->IsThere = false;
  this->Count = 0;
}

} // namespace elevation
