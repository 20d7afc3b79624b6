#include <coplane_core/ExitCodes.hpp>

namespace coplane
{
const std::vector<ExitCodeMeaning>& exitCodes()
{
  static const std::vector<ExitCodeMeaning> codes{
      {ExitCode::Success, "", "done", "all"},
      {ExitCode::Usage, "user",
       "the command line cannot be understood, or was not the same on all ranks", "all"},
      {ExitCode::Deck, "user",
       "the deck, or the recipe of a mesh, has errors, or its outputs would overwrite an input or "
       "each other",
       "all"},
      {ExitCode::Mesh, "user", "the mesh is missing, unreadable or unusable", "all"},
      {ExitCode::Output, "machine",
       "a file cannot be written: folder, permission, room, a fault of the disk, or another run "
       "that writes it",
       "all"},
      {ExitCode::Computation, "user",
       "the computation failed: an element turned inside out, something is not finite or absurdly "
       "large, the energy balance is broken, bodies go through each other; no gap of a joint "
       "balances its compression",
       "`coplane`, `coplane_point`"},
      {ExitCode::Interrupted, "", "stopped by a signal, after a last results step", "`coplane`"},
      {ExitCode::Resumable, "", "stopped on request after a checkpoint: `--restart` goes on",
       "`coplane`"},
      {ExitCode::Checkpoint, "user",
       "the checkpoint is missing, damaged, or of another mesh or deck", "`coplane`"},
      {ExitCode::Machine, "machine",
       "the machine has too little memory for what is asked; or a rank could not go on and no "
       "file is to blame",
       "all"},
      {ExitCode::Internal, "program", "a defect of the program: please report it", "all"},
  };
  return codes;
}

std::string exitCodesMarkdown()
{
  std::string text = "| code | whose fault | meaning | programs |\n|---|---|---|---|\n";
  for (const ExitCodeMeaning& code : exitCodes())
    text += fmt::format("| {} | {} | {} | {} |\n", int(code.code), code.whose, code.meaning,
                        code.programs);
  return text;
}
} // namespace coplane
