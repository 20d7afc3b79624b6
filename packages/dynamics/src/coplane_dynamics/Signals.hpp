#pragma once

namespace coplane
{
/// What a signal asks for; decided together by all ranks at the end of a cycle.
enum class Request : int
{
  None = 0,
  WriteResults = 1, ///< SIGUSR1: write a results step and go on
  Stop = 2          ///< SIGINT, SIGTERM, SIGUSR2: write a last results step and stop
};

/// Installs the handlers.
void listenToSignals();
/// The strongest request since the last call on this rank.
Request takeRequest();
} // namespace coplane
