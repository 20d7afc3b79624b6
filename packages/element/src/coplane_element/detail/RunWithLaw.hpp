#pragma once

#include <coplane_element/detail/ElementKernelData.hpp>

namespace coplane
{
/// Runs a kernel over all batches: the commonest laws become part of it; the others are called
/// once per batch.
template <template <class> class Kernel>
void runWithLaw(const ElementKernelData& data)
{
  const auto run = [&](const auto& law)
  {
    using Law = std::decay_t<decltype(law)>;
    parallelFor("coplane::element::update", data.batches, Kernel<Law>{data, law});
  };
  if (const auto* elastic = std::get_if<LinearElastic>(data.material))
    run(*elastic);
  else if (const auto* j2 = std::get_if<J2Plasticity>(data.material))
    run(*j2);
  else
    run(lawFunction(*data.material));
}
} // namespace coplane
