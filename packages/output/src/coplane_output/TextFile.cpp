#include <coplane_core/Error.hpp>
#include <coplane_output/TextFile.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace coplane
{
void failToWrite(const std::string& file)
{
  const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
  fail(ExitCode::Output,
       "{}: the file cannot be written: {}. Check that the folder '{}' exists and can be written "
       "to, and that there is room (disk, quota, file-size limit).",
       file, reason, std::filesystem::absolute(file).parent_path().string());
}

void replaceFile(const std::string& file, const std::string& text)
{
  const std::string draft = file + ".part";
  errno = 0;
  std::FILE* stream = std::fopen(draft.c_str(), "wb");
  if (!stream)
    failToWrite(file);
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int reason = errno;
  if (std::fclose(stream) != 0 || !written || std::rename(draft.c_str(), file.c_str()) != 0)
  {
    if (!written)
      errno = reason;
    const int keep = errno;
    std::remove(draft.c_str());
    errno = keep;
    failToWrite(file);
  }
}
} // namespace coplane
