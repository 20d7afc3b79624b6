#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateHex8(const ElementKernelData& data, const Material& law)
{
  updateElements<ElementType::Hex8>(data, law);
}
} // namespace coplane
