// A reader for libFuzzer, which keeps inputs that reach new code and changes them further
// (guided.sh). The environment variable COPLANE_READER says which.
#include "Readers.hpp"

#include <coplane_core/Error.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace coplane
{
namespace
{
const Reader& chosenReader()
{
  const char* const name = std::getenv("COPLANE_READER");
  for (const Reader& reader : readers())
    if (name && reader.name == name && !reader.alone)
      return reader;
  fail(ExitCode::Usage, "COPLANE_READER is '{}'; see guided.sh", name ? name : "");
}
} // namespace
} // namespace coplane

// Any exception but an Error with a message ends the process, which libFuzzer reports with its
// input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace coplane;
  static const Reader& reader = chosenReader();
  static const std::string file = "guided" + reader.extension;
  std::remove(file.c_str()); // see write() in Fuzz.cpp
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), long(size));
  try
  {
    reader.read(file);
  }
  catch (const Error& error)
  {
    if (!*error.what())
      std::abort();
  }
  return 0;
}
