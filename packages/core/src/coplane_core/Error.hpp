#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace coplane
{
/// Exit codes of all programs; documented in docs/user/exit-codes.md.
enum class ExitCode : int
{
  Success = 0,
  Usage = 2,       ///< command line
  Deck = 3,        ///< the deck has errors
  Mesh = 4,        ///< the mesh is missing, unreadable or unusable
  Output = 5,      ///< a file cannot be written
  Computation = 6, ///< the computation failed: not finite, inverted element, energy balance broken
  Interrupted = 7, ///< stopped by a signal after writing a last results step
  Resumable = 8,   ///< stopped on request after writing a checkpoint, from which it can go on
  Checkpoint = 9,  ///< the checkpoint is missing, damaged, or of another mesh or deck
  Machine = 10,    ///< the machine has too little memory, or does not give what is asked of it
  Internal = 70    ///< a defect of the program
};

/// An error for the user. The text says where, what was found, what is accepted, and what to try.
class Error : public std::runtime_error
{
public:
  Error(ExitCode code, const std::string& text, bool onAllRanks = false)
      : std::runtime_error(text), code_(code), onAllRanks_(onAllRanks)
  {
  }
  ExitCode code() const { return code_; }
  /// Whether every rank throws this error, so that the program can end in order. Otherwise other
  /// ranks may wait in a collective operation, and the program has to abort them.
  bool onAllRanks() const { return onAllRanks_; }

private:
  ExitCode code_;
  bool onAllRanks_;
};

template <class... Args>
[[noreturn]] void fail(ExitCode code, fmt::format_string<Args...> text, Args&&... args)
{
  throw Error(code, fmt::format(text, std::forward<Args>(args)...));
}

/// For decisions that every rank takes alike, from identical numbers.
template <class... Args>
[[noreturn]] void failOnAllRanks(ExitCode code, fmt::format_string<Args...> text, Args&&... args)
{
  throw Error(code, fmt::format(text, std::forward<Args>(args)...), true);
}
} // namespace coplane
