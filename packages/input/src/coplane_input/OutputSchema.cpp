#include "detail/OutputSchema.hpp"

#include <coplane_input/Deck.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

namespace coplane
{
using namespace schema;

Key outputKeys()
{
  const std::function<void(OutputCard&)> noneIsEmpty = [](OutputCard& card)
  {
    if (card.results == "none")
      card.results.clear();
  };
  return group("output", &Deck::output,
               {
                   text("results", &OutputCard::results)
                       .defaultIs("<name of the deck>.e")
                       .andThen(noneIsEmpty)
                       .like("wall.e")
                       .means("Exodus file, relative to the working folder; none: no results"),
                   number("every", &OutputCard::every)
                       .in("s")
                       .elsewhere({"dt", "interval", "frequency"})
                       .atLeast(0)
                       .like("1e-3")
                       .means("interval between results; 0: only at `times`, start and end"),
                   numbers("times", &OutputCard::times)
                       .in("s")
                       .atLeast(0)
                       .like("[0.0013, 0.002]")
                       .means("times at which results are written besides"),
                   texts("variables", &OutputCard::variables)
                       .like("[stress, von_mises]")
                       .means("of nodes and elements that the results have, by name, or by the "
                              "name of a vector or tensor without _x or _xx; displacement and "
                              "alive are always there. Without the key: all"),
                   flag("planes", &OutputCard::planes)
                       .like("false")
                       .means("contact planes as points beside the results"),
                   text("planes_format", &OutputCard::planesFormat)
                       .oneOf({"vtkhdf", "vtp"})
                       .like("vtp")
                       .means("vtkhdf: one file for all steps, and its index .xmf3, which ParaView "
                              "opens; vtp: a .vtp file for each step, and a .pvd that names them"),
                   flag("file_per_rank", &OutputCard::filePerRank)
                       .like("true")
                       .means("one results file for each rank instead of a shared one"),
                   flag("lines", &OutputCard::lines)
                       .like("true")
                       .means("the segments of lines with their forces, as <results>_lines.pvd "
                              "and a .vtp file for each step, which ParaView draws"),
                   flag("fragments", &OutputCard::fragments)
                       .like("true")
                       .means("connected bodies: mass, place, velocity, spin and box of each as "
                              "CSV file <results>_fragments.csv, and the element variable "
                              "fragment"),
                   number("fragment_damage", &OutputCard::fragmentDamage)
                       .in("-")
                       .above(0)
                       .atMost(1)
                       .like("0.9")
                       .means("of fragments: elements with this damage connect nothing"),
               })
      .means("fields for ParaView");
}

namespace
{
Key pointOfProbe(const std::string& name, std::optional<Vec3> ProbeCard::*member,
                 const std::string& meaning)
{
  Key key = bound<std::vector<Real>>(name, KeyKind::Numbers, member,
                                     [](std::optional<Vec3>& point, const std::vector<Real>& v) {
                                       point = Vec3{v[0], v[1], v[2]};
                                     })
                .in("m")
                .like("[0, 2.5, 0]")
                .means(meaning);
  key.length = 3;
  return key;
}
} // namespace

Key historyKeys()
{
  return group(
             "history", &Deck::history,
             {
                 text("file", &HistoryCard::file)
                     .defaultIs("<name of the deck>.csv")
                     .like("wall.csv")
                     .means("CSV file, relative to the working folder"),
                 number("every", &HistoryCard::every)
                     .in("s")
                     .elsewhere({"dt", "interval", "frequency"})
                     .atLeast(0)
                     .like("1e-4")
                     .means("interval between lines; 0: every cycle"),
                 list("probes", &HistoryCard::probes,
                      {
                          text("name", &ProbeCard::name)
                              .needed()
                              .like("tip")
                              .means("start of the column names; each once"),
                          text("node_set", &ProbeCard::nodeSet)
                              .like("tip")
                              .means("mean motion of a node set of the mesh"),
                          text("block", &ProbeCard::block)
                              .like("bar")
                              .means("mass-weighted mean motion of an element block"),
                          pointOfProbe("point", &ProbeCard::point,
                                       "motion of the node that is nearest at t = 0"),
                          pointOfProbe("plane", &ProbeCard::plane,
                                       "gap, closure, slip and tractions of the contact plane that "
                                       "is nearest; the point goes with the node that is nearest "
                                       "to it at t = 0"),
                          text("joint", &ProbeCard::joint)
                              .like("mortar")
                              .means("of plane: only planes of this card in joints"),
                          points("between", &ProbeCard::between)
                              .like("[[0, 0, 0], [4, 0, 0]]")
                              .means("points at equal distances on a line, from its one end to the "
                                     "other: a probe with a point for each, <name>_1, <name>_2, "
                                     "..."),
                          KeyBuilder(
                              bound<int>("count", KeyKind::Integer, &ProbeCard::count, copyTo))
                              .in("-")
                              .atLeast(2)
                              .defaultIs("2")
                              .like("9")
                              .means("of between: how many points"),
                          texts("variables", &ProbeCard::variables)
                              .like("[stress_yy, equivalent_plastic_strain]")
                              .means("variables by their names in the results, stress and strain "
                                     "whole or by component. At points those of "
                                     "the element whose middle is nearest at t = 0; of a block the "
                                     "least and the largest over its elements, of a node set over "
                                     "its nodes (displacement and velocity, whole or as _x, _y, "
                                     "_z, contact_pressure, _closure, _gap, _slip), with element "
                                     "or node and place"),
                          flag("reaction", &ProbeCard::reaction)
                              .like("true")
                              .means("of a node set: also the sum of the forces with which fixed, "
                                     "velocity, displacement, acceleration and symmetry hold its "
                                     "nodes"),
                          text("relative_to", &ProbeCard::relativeTo)
                              .elsewhere({"drift", "reference"})
                              .like("foot")
                              .means("name of another probe: displacement and velocity are less "
                                     "its own, and the drift, that displacement over the distance "
                                     "of both at t = 0, has columns, too"),
                      })
                     .exactlyOneOf({"node_set", "block", "point", "plane", "between"})
                     .means("motions, variables and planes to be recorded"),
                 bound<std::vector<std::string>>("joints", KeyKind::Texts, &HistoryCard::joints,
                                                 copyTo)
                     .defaultIs("[]")
                     .like("[\"*\"]")
                     .means("joint cards whose planes are summed up in columns: areas that are "
                            "open, stick and slip, closure, slip, force, energies; \"*\": all"),
                 bound<std::vector<std::string>>("tables", KeyKind::Texts, &HistoryCard::tables,
                                                 copyTo)
                     .oneOf({"blocks", "pairs", "materials", "lines"})
                     .defaultIs("[]")
                     .like("[blocks, pairs]")
                     .means("energies by element block, contact energies by pair of blocks and by "
                            "pair of materials, and force, strain and slip of every segment of "
                            "lines, as CSV files <history>_blocks.csv, <history>_pairs.csv, "
                            "<history>_materials.csv and <history>_lines.csv"),
                 bound<std::vector<std::string>>("rigid", KeyKind::Texts, &HistoryCard::rigid,
                                                 copyTo)
                     .defaultIs("[]")
                     .like("[\"*\"]")
                     .means("rigid blocks whose bodies are recorded in columns: motion of the "
                            "centre, spin, reaction force and moment of what prescribes their "
                            "motion; \"*\": all"),
             })
      .means("energies, momenta and probes over time");
}

Key checkpointKeys()
{
  const auto take = [](int& field, int value) { field = value; };
  return group("checkpoint", &Deck::checkpoint,
               {
                   text("file", &CheckpointCard::file)
                       .defaultIs("<name of the deck>.chk")
                       .like("wall.chk")
                       .means("checkpoints are called <file>.0 and <file>.1, written in turn, "
                              "relative to the working folder"),
                   KeyBuilder(bound<int>("every_cycles", KeyKind::Integer,
                                         &CheckpointCard::everyCycles, take))
                       .atLeast(0)
                       .in("cycles")
                       .like("5000")
                       .defaultIs("0")
                       .means("cycles between checkpoints; 0: none by count"),
                   number("every_seconds", &CheckpointCard::everySeconds)
                       .in("s")
                       .atLeast(0)
                       .like("1800")
                       .means("wall-clock time between checkpoints; 0: none by time"),
                   flag("at_end", &CheckpointCard::atEnd)
                       .like("true")
                       .means("a checkpoint at the end, to go on from with a later time.end"),
               })
      .absent("every", "Checkpoints come by count of cycles (every_cycles) or by the clock on the "
                       "wall (every_seconds), not by the time of the model.")
      .means("state of the run, for --restart; without this group only when asked for (signals, "
             "--max-wall, a file <name>.stop)");
}

Key partitionKeys()
{
  return section("partition",
                 {
                     text("method", &Deck::partitionMethod)
                         .oneOf({"multijagged", "rcb", "rib", "hsfc", "hypergraph"})
                         .like("rcb")
                         .means("method of Zoltan2"),
                     text("balance", &Deck::partitionBalance)
                         .oneOf({"cost", "nodes"})
                         .like("nodes")
                         .means("what every rank gets as much of: estimated cost of elements, "
                                "laws and contact, or nodes"),
                     text("rebalance", &Deck::rebalance)
                         .oneOf({"never", "auto", "always"})
                         .like("never")
                         .means("whether the mesh is dealt out anew during the run, by the "
                                "measured work of the ranks; auto: when that saves more time than "
                                "it costs; always: at every look, for tests"),
                     KeyBuilder(bound<int>("rebalance_every", KeyKind::Integer,
                                           &Deck::rebalanceEvery, copyTo))
                         .atLeast(1)
                         .in("cycles")
                         .like("2000")
                         .defaultIs(std::to_string(Deck{}.rebalanceEvery))
                         .means("cycles from one look at the work of the ranks to the next"),
                     number("rebalance_above", &Deck::rebalanceAbove)
                         .in("-")
                         .atLeast(1)
                         .like("1.3")
                         .means("the busiest rank's work over the mean of all ranks from which "
                                "on auto asks whether a rebalance pays"),
                 })
      .means("how elements are dealt out to ranks; the results do not depend on it");
}
} // namespace coplane
