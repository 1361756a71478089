// Asks memory for what will be needed soon, where a processor does not see by itself what comes next. Nothing waits for it, and nothing
// depends on it but the time.
#pragma once
#include <cstddef>

namespace dem {

enum class Use : int { read = 0, write = 1 };

// All lines of a value, whose first byte begins one; of others perhaps without the last.
template <Use use = Use::read, class T>
inline void ask_memory_for(const T& value) {
  constexpr std::size_t line = 64;
  const char* const begin = reinterpret_cast<const char*>(&value);
  for (std::size_t byte = 0; byte < sizeof(T); byte += line) __builtin_prefetch(begin + byte, int(use));
}

}  // namespace dem
