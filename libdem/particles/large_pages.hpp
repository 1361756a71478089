// Arrays that every step goes through, in pages of 2 MB where the system has them: an array of tens of megabytes needs thousands of
// pages of 4 kB, more than the processor keeps at hand.
#pragma once
#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace dem {

template <class T>
struct LargePageAllocator {
  using value_type = T;
  static constexpr std::size_t page = std::size_t{1} << 21;

  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}

  // Arrays below a page lie wherever they fit.
  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    void* memory = ::operator new(bytes, alignment(n));
#ifdef MADV_HUGEPAGE
    if (bytes >= page) madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: where it is not granted nothing changes
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) { ::operator delete(memory, alignment(n)); }

  template <class Other>
  bool operator==(const LargePageAllocator<Other>&) const {
    return true;
  }

 private:
  static std::align_val_t alignment(std::size_t n) {
    return std::align_val_t(n * sizeof(T) >= page ? page : std::max(alignof(T), std::size_t{__STDCPP_DEFAULT_NEW_ALIGNMENT__}));
  }
};

template <class T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

}  // namespace dem
