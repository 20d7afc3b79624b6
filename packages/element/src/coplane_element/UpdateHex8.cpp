#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using Hex8Kernel = ElementKernel<ElementType::Hex8, Law>;

void updateHex8(const ElementKernelData& data)
{
  runWithLaw<Hex8Kernel>(data);
}
} // namespace coplane
