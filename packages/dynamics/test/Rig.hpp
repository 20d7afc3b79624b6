#pragma once

#include <coplane_dynamics/Solver.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// By a method of nodeOwners(), or with scattered nodes, or all on the last rank.
std::vector<int> ownersBy(const std::string& method, const Mesh& mesh, const Comm& comm);

/// Tests of what contact by either way of computing forces has in common: while one of them runs,
/// models are made with the usual options of its parameter.
struct WithForces : testing::TestWithParam<ContactOptions::Forces>
{
  WithForces() { usual = ContactOptions::with(GetParam()); }
  ~WithForces() override { usual = {}; }
  static bool potential() { return usual.forces == ContactOptions::Forces::Potential; }

  static auto both()
  {
    return testing::Values(ContactOptions::Forces::Potential, ContactOptions::Forces::CommonNormal);
  }
  static std::string name(const testing::TestParamInfo<ParamType>& info)
  {
    return info.param == ContactOptions::Forces::Potential ? "potential" : "commonNormal";
  }

  inline static ContactOptions usual;
};

/// Every block of the same elastic rock (1 GPa, 0.25, 1000 kg/m^3: waves run at 1095 m/s), every
/// pair of blocks with the same penalty law.
Model rockModel(const Mesh& mesh, const Comm& comm, Real friction = 0,
                const std::string& method = "multijagged");

/// Two cubes of 2^3 elements of 0.5 m, the upper one shifted so that every face meets several.
///
///      +-------+        z
///      | upper |        |
///    +-+-----+-+        +-- x
///    | lower |
///    +-------+
Mesh twoCubes(Real gap = 0);

/// The upper cube falls on the lower one and slides over it.
Model slidingCubes(const Comm& comm, const std::string& method = "multijagged");

std::vector<int> ownedNodesWhere(const RankMesh& mesh,
                                 const std::function<bool(const Vec3&)>& chosen);

/// Exterior faces of which all corners are chosen.
std::vector<FacePressure::Side> sidesWhere(const RankMesh& mesh,
                                           const std::function<bool(const Vec3&)>& chosen);

FacePressure pressureWhere(const RankMesh& mesh, Real pressure,
                           const std::function<bool(const Vec3&)>& chosen);

/// A body that is partly rigid slides over one that loses elements, under loads and damping.
Model everything(const Comm& comm, const std::string& method = "multijagged");

/// Sum over the owned nodes of all ranks.
Vec3 sumOverRanks(const NodeVectors& vectors, int owned, const Comm& comm);

/// Largest |vector| of all nodes of all ranks.
Real largest(const NodeVectors& vectors, int owned, const Comm& comm);

/// Hash of positions and velocities, without planes and elements.
std::uint64_t nodeHash(const Solver& solver);

void cycles(Solver& solver, int n);

/// Counts its calls and remembers how the run ended.
struct Recorder : Observer
{
  int starts = 0, ends = 0;
  Ending ending;
  void start(const Solver&) override { ++starts; }
  void endOfCycle(const Solver&) override { ++ends; }
  void finish(const Solver&, const Ending& how) override { ending = how; }
};
} // namespace coplane
