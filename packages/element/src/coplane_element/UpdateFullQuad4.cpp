#include <coplane_element/detail/FullKernel.hpp>

namespace coplane
{
template <class Law>
using FullQuad4Kernel = FullKernel<ElementType::Quad4, Law>;

void updateFullQuad4(const ElementKernelData& data)
{
  runWithLaw<FullQuad4Kernel>(data);
}
} // namespace coplane
