#pragma once

#include "MaterialPaths.hpp"

#include <coplane_input/Deck.hpp>
#include <coplane_schema/Schema.hpp>

namespace coplane
{
/// The elements behind the faces: penalty joints take their stiffness from them, curves the cap of
/// their slope.
struct ElementCard
{
  Real thickness = 0; ///< h [m]; 0: rigid
  Real modulus = 0;   ///< P-wave modulus M [Pa]; 0: rigid

  bool isRigid() const { return thickness <= 0 || modulus <= 0; }
};

/// A path on which a joint is led.
struct JointPathCard
{
  std::string name, where;
  std::string joint;
  std::string type; ///< closing | shear | circle | points
  bool declared = true;
  int steps = 200;
  Real speed = 0.01; ///< [m/s]
  std::string output;
  std::vector<Real> closures;    ///< closing [m]
  std::vector<Real> slips;       ///< shear [m]
  Real normalTraction = 0;       ///< shear, circle [Pa]
  Real surroundingStiffness = 0; ///< shear, circle [Pa/m]
  Real radius = 0;               ///< circle [m]
  Real turns = 1;                ///< circle [-]
  std::string file;              ///< points
  std::vector<Real> times, gaps, slipsX, slipsY;
};

struct PointDeck
{
  std::string file;
  std::vector<std::string> warnings; ///< about values that are accepted, but most likely not meant
  std::string title;
  std::vector<JointCard> joints;
  ElementCard elements;
  std::vector<JointPathCard> jointPaths;
  std::vector<MaterialCard> materials;
  std::vector<MaterialPathCard> materialPaths;
};

const Key& pointSchema();

/// Reads and checks a deck of coplane_point. Throws Error(ExitCode::Deck) with every problem that
/// was found, one per line.
PointDeck readPointDeck(const std::string& file, const std::vector<std::string>& overrides = {});
PointDeck parsePointDeck(const std::string& text, const std::string& file,
                         const std::vector<std::string>& overrides = {});
} // namespace coplane
