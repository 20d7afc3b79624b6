#include <coplane_element/detail/FullKernel.hpp>

namespace coplane
{
template <class Law>
using FullHex8Kernel = FullKernel<ElementType::Hex8, Law>;

void updateFullHex8(const ElementKernelData& data)
{
  runWithLaw<FullHex8Kernel>(data);
}
} // namespace coplane
