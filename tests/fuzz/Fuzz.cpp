// Gives spoilt files to a reader: coplane_fuzz READER [--count N] [--seed S] FILE|FOLDER ...
//
// Files of a folder are taken as they are (corpus/READER), with N more made of all of them.
// Every file must be read, or refused with an Error: no crash, no other exception, nothing that
// takes longer than 90 s, no memory that is lost. A file that does anything else is kept beside the
// working folder under the name that is printed. Files are read in a child process, so that one
// crash does not end the search; what a library prints about them goes to read.log.
#include "Mutations.hpp"
#include "Readers.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace coplane
{
namespace
{
constexpr unsigned longestRead = 90; // s; opening a mesh gives up after 60

/// What the child tells its parent; in memory that both see.
struct Progress
{
  int file = 0; ///< being read
  int read = 0, refused = 0, foreign = 0;
  long growth = 0; ///< of the memory in use over the files after the first hundred [bytes]
  int measured = 0;
};

void write(const std::string& path, const std::string& content)
{
  // ext4 waits for the disk where a file is cut to nothing and written again.
  std::remove(path.c_str());
  std::ofstream(path, std::ios::binary) << content;
}

enum class Outcome : int
{
  Read,
  Refused = 10,
  Foreign ///< an exception that is no Error, or an Error without a word
};

Outcome outcomeOf(const Reader& reader, const std::string& path)
{
  try
  {
    reader.read(path);
    return Outcome::Read;
  }
  catch (const Error& error)
  {
    return *error.what() ? Outcome::Refused : Outcome::Foreign;
  }
  catch (const std::exception& error)
  {
    std::cout << "an exception that is no Error: " << error.what() << '\n';
    return Outcome::Foreign;
  }
}

std::string keptName(const Reader& reader, int file)
{
  return reader.name + "-" + std::to_string(file) + reader.extension;
}

void addFiles(const std::string& folder, std::vector<std::string>& to)
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names)
    to.push_back(textOfFile(name));
}

const Reader* readerOf(const std::string& name)
{
  for (const Reader& reader : readers())
    if (reader.name == name)
      return &reader;
  return nullptr;
}

/// Reads files [from, to) and ends the process.
[[noreturn]] void readAll(const Reader& reader, Mutations mutations, int from, int to,
                          const std::string& path, Progress& progress)
{
  std::size_t before = 0;
  if (!std::freopen("read.log", "w", stderr))
    _exit(1);
  for (int i = 0; i < to; ++i)
  {
    const std::string content = mutations.next();
    if (i < from)
      continue;
    progress.file = i;
    write(path, content);
    alarm(longestRead);
    if (reader.alone)
    {
      execl("/proc/self/exe", "coplane_fuzz", "--read", reader.name.c_str(), path.c_str(), nullptr);
      _exit(1);
    }
    switch (outcomeOf(reader, path))
    {
    case Outcome::Read:
      ++progress.read;
      break;
    case Outcome::Refused:
      ++progress.refused;
      break;
    case Outcome::Foreign:
      write(keptName(reader, i), content);
      ++progress.foreign;
    }
    alarm(0);
    if (i == from + 100)
      before = mallinfo2().uordblks;
  }
  if (before > 0)
  {
    progress.growth += long(mallinfo2().uordblks) - long(before);
    progress.measured += to - from - 101;
  }
  std::cout.flush();
  _exit(0);
}
} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  using namespace coplane;
  if (argc == 4 && std::string(argv[1]) == "--read" && readerOf(argv[2]))
    return int(outcomeOf(*readerOf(argv[2]), argv[3]));
  const Reader* const reader = argc > 1 ? readerOf(argv[1]) : nullptr;
  int count = 1000;
  std::uint64_t seed = 1;
  std::vector<std::string>& good = goodFiles();
  for (int i = 2; i < argc && reader; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--count" && i + 1 < argc)
      count = std::atoi(argv[++i]);
    else if (argument == "--seed" && i + 1 < argc)
      seed = std::strtoull(argv[++i], nullptr, 10);
    else if (std::filesystem::is_directory(argument))
      addFiles(argument, good);
    else
      good.push_back(reader->goodFile(argument));
  }
  count += int(good.size());
  if (good.empty())
  {
    std::cerr << "usage: coplane_fuzz READER [--count N] [--seed S] FILE|FOLDER ...\nreaders:";
    for (const Reader& candidate : readers())
      std::cerr << ' ' << candidate.name;
    std::cerr << '\n';
    return 2;
  }
  const std::string path = "spoilt" + reader->extension;
  auto& progress = *new (mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Progress;
  int crashed = 0, hung = 0;
  for (int from = 0; from < count;)
  {
    std::cout.flush();
    const pid_t child = fork();
    if (child == 0)
      readAll(*reader, Mutations(good, seed), from,
              reader->alone ? std::min(count, from + 1) : count, path, progress);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status))
    {
      const int code = WEXITSTATUS(status);
      progress.read += reader->alone && code == int(Outcome::Read);
      progress.refused +=
          reader->alone && (code == int(Outcome::Refused) || code == int(ExitCode::Mesh));
      from = progress.file + 1;
      if (code == 0 || code == int(Outcome::Refused) || code == int(ExitCode::Mesh))
        continue;
    }
    const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
    ++(slow ? hung : crashed);
    const std::string kept = keptName(*reader, progress.file);
    std::ifstream in(path, std::ios::binary);
    std::ofstream(kept, std::ios::binary) << in.rdbuf();
    std::cout << kept << ": " << (slow ? "takes too long" : "crashed") << '\n';
    from = progress.file + 1;
  }
  const double growth = progress.measured > 0 ? double(progress.growth) / progress.measured : 0;
  std::cout << reader->name << ": " << count << " files, " << progress.read << " read, "
            << progress.refused << " refused, " << progress.foreign << " other exceptions, "
            << crashed << " crashes, " << hung << " too slow, " << growth
            << " bytes kept per file\n";
  const bool leaks = growth > reader->bytesKept;
  return crashed + hung + progress.foreign > 0 || leaks ? 1 : 0;
}
