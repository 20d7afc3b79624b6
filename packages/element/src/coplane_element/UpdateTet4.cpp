#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using Tet4Kernel = ElementKernel<ElementType::Tet4, Law>;

void updateTet4(const ElementKernelData& data)
{
  runWithLaw<Tet4Kernel>(data);
}
} // namespace coplane
