#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_core/Real.hpp>

#include <functional>
#include <string>

namespace coplane
{
/// What a process of its own says of its work while it goes on.
class Stages
{
public:
  virtual ~Stages() = default;
  /// @param what is done from now on, for a sentence with "while"
  /// @param limit until the next stage begins, or the end [s]; 0: none
  virtual void begin(const std::string& what, Real limit = 0) = 0;
};

/// How work in a process of its own ended.
struct ApartOutcome
{
  enum class End
  {
    Done,   ///< `bytes` are the result
    Failed, ///< `code` and `bytes` are those of the exception
    Died,   ///< by `signal`, or without a word
    Late    ///< it was ended after the limit of its stage
  };
  End end = End::Done;
  std::string bytes;
  ExitCode code = ExitCode::Success;
  int signal = 0;
  std::string stage; ///< the last that began
};

/// Does work in a child of this process, so that a library that crashes or hangs takes nothing
/// along. Only what the work returns comes back. The child dies with this process. To be called
/// while the process has one thread, no MPI and no file to write.
ApartOutcome runApart(const std::function<std::string(Stages&)>& work);

/// "segmentation fault (signal 11)"
std::string nameOfSignal(int signal);
} // namespace coplane
