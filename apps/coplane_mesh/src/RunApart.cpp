#include "RunApart.hpp"

#include <coplane_core/Abort.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace coplane
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Both processes see it.
struct Board
{
  std::atomic<int> number{0}; ///< of the stage
  std::atomic<double> limit{0};
  char text[240]{}; ///< what the child writes before it counts the number up
};

class SharedStages : public Stages
{
public:
  explicit SharedStages(Board& board) : board_(board) {}
  void begin(const std::string& what, Real limit) override
  {
    std::strncpy(board_.text, what.c_str(), sizeof(board_.text) - 1);
    board_.limit = limit;
    ++board_.number;
  }

private:
  Board& board_;
};

[[noreturn]] void refuse(const char* what)
{
  fail(ExitCode::Machine, "a process of its own cannot be had ({}: {}).", what,
       std::strerror(errno));
}

/// Writes all of it; who reads no more has ended.
void send(int pipe, const void* data, std::size_t size)
{
  for (const char* at = static_cast<const char*>(data); size > 0;)
  {
    const ssize_t sent = ::write(pipe, at, size);
    if (sent < 0 && errno == EINTR)
      continue;
    if (sent <= 0)
      return;
    at += sent;
    size -= std::size_t(sent);
  }
}

/// What goes through the pipe begins with the end and the code.
void sendEnd(int pipe, ApartOutcome::End end, ExitCode code, const std::string& bytes)
{
  const int head[2] = {int(end), int(code)};
  send(pipe, head, sizeof(head));
  send(pipe, bytes.data(), bytes.size());
  const char last = '.'; // so that a text that was cut off is known
  send(pipe, &last, 1);
}

[[noreturn]] void beChild(const std::function<std::string(Stages&)>& work, Board& board, int pipe,
                          pid_t parent)
{
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent)
    ::_exit(1);
#else
  (void)parent;
#endif
  const rlimit none{0, 0}; // a crash that is told needs no picture of the memory
  ::setrlimit(RLIMIT_CORE, &none);
  SharedStages stages(board);
  try
  {
    sendEnd(pipe, ApartOutcome::End::Done, ExitCode::Success, work(stages));
  }
  catch (const std::exception& error)
  {
    sendEnd(pipe, ApartOutcome::End::Failed, codeOf(error), textOf(error));
  }
  ::_exit(0); // files and streams are the parent's
}

/// Reads until the child closes its end. Returns whether it was late.
bool receive(int pipe, const Board& board, pid_t child, std::string& bytes)
{
  int stage = -1;
  Clock::time_point begin = Clock::now();
  for (std::string buffer(1 << 16, '\0');;)
  {
    if (const int now = board.number; now != stage)
    {
      stage = now;
      begin = Clock::now();
    }
    const double limit = board.limit;
    if (limit > 0 && std::chrono::duration<double>(Clock::now() - begin).count() > limit)
    {
      ::kill(child, SIGKILL);
      return true;
    }
    pollfd wait{pipe, POLLIN, 0};
    if (::poll(&wait, 1, 100) <= 0)
      continue;
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got == 0)
      return false;
    if (got > 0)
      bytes.append(buffer, 0, std::size_t(got));
    else if (errno != EINTR)
      refuse("read");
  }
}
} // namespace

ApartOutcome runApart(const std::function<std::string(Stages&)>& work)
{
  void* memory =
      ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    refuse("mmap");
  Board& board = *new (memory) Board;
  int ends[2];
  if (::pipe(ends) != 0)
    refuse("pipe");
  std::fflush(nullptr);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0)
    refuse("fork");
  if (child == 0)
  {
    ::close(ends[0]);
    beChild(work, board, ends[1], parent);
  }
  ::close(ends[1]);
  ApartOutcome outcome;
  std::string bytes;
  const bool late = receive(ends[0], board, child, bytes);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
  outcome.stage = board.text;
  ::munmap(memory, sizeof(Board));
  int head[2];
  if (late)
    outcome.end = ApartOutcome::End::Late;
  else if (WIFSIGNALED(status) || bytes.size() <= sizeof(head) || bytes.back() != '.')
  {
    outcome.end = ApartOutcome::End::Died;
    outcome.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }
  else
  {
    std::memcpy(head, bytes.data(), sizeof(head));
    outcome.end = ApartOutcome::End(head[0]);
    outcome.code = ExitCode(head[1]);
    outcome.bytes.assign(bytes, sizeof(head), bytes.size() - sizeof(head) - 1);
  }
  return outcome;
}

std::string nameOfSignal(int signal)
{
  const char* name = ::strsignal(signal);
  std::string text = name ? name : "unknown";
  std::transform(text.begin(), text.begin() + 1, text.begin(),
                 [](char letter) { return char(std::tolower(letter)); });
  return fmt::format("{} (signal {})", text, signal);
}
} // namespace coplane
