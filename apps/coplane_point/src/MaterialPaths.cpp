#include "MaterialPaths.hpp"

#include "ErrorsOfPaths.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
constexpr const char* componentNames[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};
using RecordMaterial = std::function<void(const MaterialProbe&)>;

std::array<Real, 6> componentsOf(const SymTensor& s)
{
  return {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
}

/// From the present strains and stresses to the targets, in equal steps. A component is a stress
/// where `stressGiven`.
void leadTo(MaterialProbe& probe, const std::array<bool, 6>& stressGiven,
            const std::array<Real, 6>& target, int steps, Real duration,
            const RecordMaterial& record)
{
  const auto strain = componentsOf(probe.strain()), stress = componentsOf(probe.stress());
  ProbeStep step;
  step.stressGiven = stressGiven;
  step.dt = duration / steps;
  for (int i = 1; i <= steps; ++i)
  {
    for (int k = 0; k < 6; ++k)
      step.value[k] = stressGiven[k] ? stress[k] + (target[k] - stress[k]) * i / steps
                                     : (target[k] - strain[k]) / steps;
    probe.advance(step);
    record(probe);
  }
}

/// Under pressure on all sides.
void confine(const MaterialPathCard& card, MaterialProbe& probe, const RecordMaterial& record)
{
  const Real p = card.confinement;
  const Real duration = p / (pWaveModulus(probe.material()) * card.rate);
  leadTo(probe, {true, true, true, true, true, true}, {-p, -p, -p, 0, 0, 0}, card.steps, duration,
         record);
}

void mixed(const MaterialPathCard& card, MaterialProbe& probe, const RecordMaterial& record)
{
  std::array<bool, 6> stressGiven{};
  for (int k = 0; k < 6; ++k)
    stressGiven[k] = std::find(card.stressComponents.begin(), card.stressComponents.end(),
                               componentNames[k]) != card.stressComponents.end();
  for (std::size_t i = 0; i < card.times.size(); ++i)
  {
    std::array<Real, 6> target;
    for (int k = 0; k < 6; ++k)
      target[k] = card.values[k].empty() ? 0 : card.values[k][i];
    leadTo(probe, stressGiven, target, card.steps, card.times[i] - (i ? card.times[i - 1] : 0),
           record);
  }
}

/// The axes on which a type of path keeps the stress, and the share of its strain on every axis.
struct PathType
{
  std::array<bool, 6> stressGiven;
  std::array<Real, 6> share;
};

PathType typeOf(const MaterialPathCard& card)
{
  const bool held = card.confinement > 0;
  if (card.type == "uniaxial_stress")
    return {{false, true, true, false, false, false}, {1, 0, 0, 0, 0, 0}};
  if (card.type == "biaxial")
    return {{false, false, true, false, false, false}, {1, 1, 0, 0, 0, 0}};
  if (card.type == "hydrostatic")
    return {{}, {1. / 3, 1. / 3, 1. / 3, 0, 0, 0}};
  if (card.type == "shear")
    return {{held, held, held, false, false, false}, {0, 0, 0, 1, 0, 0}};
  return {{}, {1, 0, 0, 0, 0, 0}};
}
} // namespace

std::vector<Key> materialPathKeys()
{
  const auto takeSteps = [](int& field, int value) { field = value; };
  const std::vector<std::string> simple = {"uniaxial_stress", "uniaxial_strain", "biaxial",
                                           "hydrostatic", "shear"};
  std::vector<Key> keys = {
      text("type", &MaterialPathCard::type)
          .needed()
          .oneOf({"uniaxial_stress", "uniaxial_strain", "biaxial", "hydrostatic", "shear", "mixed"})
          .like("uniaxial_stress")
          .means("uniaxial_stress: strain along x, the stress on the other axes is kept (with "
                 "confinement: a triaxial test); uniaxial_strain: strain along x only; biaxial: "
                 "equal strains along x and y, z free; hydrostatic: volume strain; shear: tensor "
                 "strain xy (with confinement: the normal stresses are kept, else the volume); "
                 "mixed: each component by strain or by stress"),
      text("material", &MaterialPathCard::material)
          .needed()
          .like("concrete")
          .means("name of a card in materials, or of a set of the library"),
      bound<int>("steps", KeyKind::Integer, &MaterialPathCard::steps, takeSteps)
          .atLeast(1)
          .in("steps")
          .like("1000")
          .defaultIs(fmt::format("{}", MaterialPathCard{}.steps))
          .means("from one point of the path to the next"),
      number("size", &MaterialPathCard::size)
          .in("m")
          .above(0)
          .like("0.05")
          .means("of the element that the point stands for: the crack band"),
      number("rate", &MaterialPathCard::rate)
          .onlyFor(simple)
          .in("1/s")
          .above(0)
          .like("100")
          .means("rate of strain, for laws that depend on it"),
      number("confinement", &MaterialPathCard::confinement)
          .onlyFor({"uniaxial_stress", "shear"})
          .in("Pa")
          .atLeast(0)
          .like("10e6")
          .means("pressure on all sides before the path, kept where no strain is prescribed"),
      numbers("strains", &MaterialPathCard::strains)
          .onlyFor(simple)
          .needed()
          .in("-")
          .like("[-0.01, 0]")
          .means("visited in turn from 0, or from the confined state; tension is positive"),
      numbers("times", &MaterialPathCard::times)
          .onlyFor({"mixed"})
          .needed()
          .in("s")
          .above(0)
          .like("[1, 2]")
          .means("of the points, rising; the path starts at 0 without strain and stress"),
      bound<std::vector<std::string>>("stresses", KeyKind::Texts,
                                      &MaterialPathCard::stressComponents, copyTo)
          .onlyFor({"mixed"})
          .oneOf({"xx", "yy", "zz", "xy", "yz", "zx"})
          .defaultIs("[]")
          .like("[yy, zz]")
          .means("components that are stresses [Pa]; the others are strains"),
      text("output", &MaterialPathCard::output)
          .like("concrete.csv")
          .defaultIs("<name of the deck>_<name of the path>.csv")
          .means("CSV file, relative to the working folder"),
  };
  for (int k = 0; k < 6; ++k)
  {
    Key key = numbers("times", &MaterialPathCard::times)
                  .onlyFor({"mixed"})
                  .in("-")
                  .defaultIs("all 0")
                  .like("[-1e-3, 0]")
                  .means("strain (tensor component), or stress [Pa] when named in stresses, at "
                         "`times`");
    key.name = componentNames[k];
    key.store = [k](void* target, const KeyValue& value)
    { static_cast<MaterialPathCard*>(target)->values[k] = std::get<std::vector<Real>>(value); };
    keys.push_back(key);
  }
  return keys;
}

void followPath(const MaterialPathCard& card, MaterialProbe probe, const RecordMaterial& record)
{
  record(probe);
  if (card.type == "mixed")
    return mixed(card, probe, record);
  if (card.confinement > 0)
    confine(card, probe, record);
  const PathType type = typeOf(card);
  const auto start = componentsOf(probe.strain());
  Real from = 0;
  for (const Real to : card.strains)
  {
    std::array<Real, 6> target;
    for (int k = 0; k < 6; ++k)
      target[k] =
          type.stressGiven[k] ? (k < 3 ? -card.confinement : 0) : start[k] + type.share[k] * to;
    const Real duration = std::max(std::abs(to - from), 1e-12) / card.rate;
    leadTo(probe, type.stressGiven, target, card.steps, duration, record);
    from = to;
  }
}

std::string runMaterialPath(const MaterialPathCard& card, const Material& material)
{
  std::string header = "time[s]";
  for (const char* component : componentNames)
    header += fmt::format(",strain_{}[-]", component);
  for (const char* component : componentNames)
    header += fmt::format(",stress_{}[Pa]", component);
  header += ",pressure[Pa],von_mises[Pa],volume_ratio[-],energy[J/m^3],dissipation[J/m^3],"
            "stiffening[-]";
  const std::string sameOfAll = header;
  const std::vector<std::string> names = historyNames(material);
  for (const std::string& name : names)
    header += "," + name;
  TextDraft draft(placeOfFile(card.output));
  draft.add(header + "\n");

  int lines = 0;
  Real compression = 0, tension = 0, mises = 0, energy = 0, dissipation = 0;
  const auto write = [&](const MaterialProbe& probe)
  {
    std::string line = fmt::format("{:.17g}", probe.time());
    const auto put = [&](Real value) { line += fmt::format(",{:.17g}", value); };
    for (const SymTensor& tensor : {probe.strain(), probe.stress()})
      for (const Real value : componentsOf(tensor))
        put(value);
    for (const Real value : {probe.pressure(), probe.vonMises(), probe.volumeRatio(),
                             probe.energy(), probe.dissipation(), probe.stiffening()})
      put(value);
    for (std::size_t k = 0; k < names.size(); ++k)
      put(probe.history()[k]);
    draft.add(line + "\n");
    ++lines;
    if (!std::isfinite(probe.pressure() + probe.vonMises() + probe.volumeRatio() + probe.energy() +
                       probe.dissipation()))
      fail(ExitCode::Computation,
           "at t = {:.6g} s stresses or energies are not finite: pressure {:g} Pa, von Mises {:g} "
           "Pa, volume ratio {:g}, energy {:g} J/m^3. Look at the path and at the moduli.",
           probe.time(), probe.pressure(), probe.vonMises(), probe.volumeRatio(), probe.energy());
    const SymTensor& s = probe.stress();
    compression = std::max({compression, -s.xx, -s.yy, -s.zz});
    tension = std::max({tension, s.xx, s.yy, s.zz});
    mises = std::max(mises, probe.vonMises());
    energy = probe.energy();
    dissipation = probe.dissipation();
  };
  withPlaceOf(card, "material_paths",
              [&] { followPath(card, MaterialProbe(material, card.size), write); });
  draft.close();
  makeWayFor(placeOfFile(card.output),
             [&](const std::string& there) { return beginsWith(there, sameOfAll); });
  draft.finish();
  return fmt::format("{}: {} of material '{}'\n"
                     "  peaks [Pa]: compression {:.6g}, tension {:.6g}, von Mises {:.6g}\n"
                     "  energy {:.6g} J/m^3, of which {:.6g} J/m^3 dissipated\n"
                     "  {} points in {}",
                     card.name, card.type, card.material, compression, tension, mises, energy,
                     dissipation, lines, card.output);
}
} // namespace coplane
