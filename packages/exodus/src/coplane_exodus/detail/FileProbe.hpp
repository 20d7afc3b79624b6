#pragma once

#include <string>
#include <vector>

namespace coplane
{
enum class ProgramEnd
{
  Success, ///< exit code 0
  Failure, ///< another exit code, or a signal
  TooLong, ///< it was killed
  Unknown  ///< there is no such program, it cannot run here, or the system does not tell
};

/// Runs a program without input and output, and waits for it.
/// @param command its file and arguments; seconds: after which it is killed
ProgramEnd runProgram(std::vector<std::string> command, double seconds);

/// Throws Error(ExitCode::Mesh) unless the libraries may be given the file. One rank asks for all,
/// before any of them opens it. `coplane_mesh probe` in the folder of the running program looks
/// into an HDF5 file first; where it is not there, such a file is read unprobed, with a warning.
void demandMeshFile(const std::string& file);

[[noreturn]] void refuseMeshFile(const std::string& file);
} // namespace coplane
