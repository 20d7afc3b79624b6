#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// Logarithmic strain of an element of this rank at its middle, counted as strainReference() of the
/// solver says; 0 of dead ones, whose nodes no longer tell it [-].
SymTensor strainOf(const Solver& solver, int block, int element);

/// A variable of an element of this rank by its name in the results, such as stress_yy; nothing:
/// its law has none of this name.
std::optional<Real> elementVariable(const Solver& solver, int block, int element,
                                    const std::string& name);
/// The names, with `stress` and `strain` as their six components.
std::vector<std::string> byComponent(const std::vector<std::string>& variables);
/// "[Pa]" and the like; empty for variables of laws.
std::string unitOfVariable(const std::string& name);

/// The owned node that is nearest to a point at the start, on the rank that has it; of several the
/// one of the lowest id. -1 on other ranks. Collective.
int nearestNode(const Solver& solver, const Vec3& point);

/// An element of this rank; block -1: it is on another.
struct ProbedElement
{
  int block = -1, element = -1;
};
/// The same of elements, by their middles.
ProbedElement nearestElement(const Solver& solver, const Vec3& point);

/// Least or largest value, with the element or node that has it (the lowest id) and its present
/// place, the middle of an element. Without living elements, or nodes, no number, and id 0.
struct Extreme
{
  Real value = 0;
  GlobalId id = 0;
  Vec3 place{}; ///< [m]
};
/// Of the living elements of a block. [2 i]: least, [2 i + 1]: largest of variable i. Collective.
std::vector<Extreme> extremesOf(const Solver& solver, int block,
                                const std::vector<std::string>& variables);

/// The same of the nodes of a set, and nodalVariables(). Collective.
std::vector<Extreme> nodalExtremesOf(const Solver& solver, int nodeSet,
                                     const std::vector<std::string>& variables);
} // namespace coplane
