#include "libdem/contact/forces.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "libdem/contact/chunk_shares.hpp"
#include "libdem/contact/pair_kernel.hpp"
#include "libdem/contact/wall_kernel.hpp"
#include "libdem/errors.hpp"

namespace dem {
namespace {

// All contacts of one chunk of grains that are due; nobody else adds forces to these grains meanwhile.
template <class Law, bool Keep>
void evaluate_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, std::size_t number,
                    std::optional<std::uint32_t> next, const kernel::ChunkOutput& out) {
  kernel::evaluate_pair_chunk<Law, Keep>(law, in, pairs, number, next, out);
  for (WallContacts::Chunk& chunk : walls.chunks_of(number)) kernel::evaluate_wall_chunk<Law, Keep>(law, in, walls, chunk, out);
}

// Stays awake, but gives the processor to whoever else wants it.
template <class Condition>
void wait_until(Condition condition) {
  for (int spins = 0; !condition(); ++spins)
    if (spins > 100) std::this_thread::yield();
}

bool pending(PairContacts::Chunk& chunk) { return std::atomic_ref(chunk.pending).load(std::memory_order_acquire) != 0; }

enum class Progress : std::uint8_t { to_evaluate, waiting, taken };  // of a chunk; taken by whoever finishes it

// Each thread takes the next chunk of its share, evaluates it and finishes it. If chunks that send forces to it are still to be evaluated, it
// keeps its sheet and looks again after each of the next. When none is left to take, all finish together what still waits, each first what it
// has evaluated, whose grains its caches hold.
template <class Law, bool Keep>
double evaluate_all(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, const ForceOutput& out,
                    const FinishChunk& finish) {
  const std::size_t count = in.due_chunks.size();
  for (const std::uint32_t number : in.due_chunks) pairs.chunk[number].pending = 1;
  const std::size_t threads = count >= RowChunks::few ? std::size_t(omp_get_max_threads()) : 1;
  std::vector<std::atomic<Progress>> progress(count);
  std::vector<std::unique_ptr<ForceSheet>> kept(count);  // of chunks that wait
  out.sheets.prepare(threads);
  std::atomic<std::size_t> finished = 0;
  ChunkShares shares(threads, [&](std::size_t thread) {
    const std::size_t chunk = pairs.chunk.size() * thread / threads;
    return std::ranges::lower_bound(in.due_chunks, chunk) - in.due_chunks.begin();
  });
#pragma omp parallel num_threads(int(threads))
  {
    const std::size_t me = std::size_t(omp_get_thread_num());
    const auto ready = [&](std::size_t k) {
      return std::ranges::none_of(pairs.chunk[in.due_chunks[k]].senders, [&](std::uint32_t sender) { return pending(pairs.chunk[sender]); });
    };
    const auto finish_with = [&](std::size_t k, ForceSheet& sheet) {
      kernel::add_crossing(pairs, in.chunks, in.due_chunks[k], in.due, sheet, out.asked);
      finish(k, sheet);
      ++finished;
    };
    std::unique_ptr<ForceSheet>& sheet = out.sheets.of_thread(me);
    std::vector<std::uint32_t> waiting;  // of those that I have evaluated
    // True where it is finished, or being finished by another.
    const auto finish_if_ready = [&](std::size_t k) {
      Progress as = progress[k].load(std::memory_order_relaxed);
      if (as != Progress::waiting) return as == Progress::taken;
      if (!ready(k)) return false;
      if (progress[k].compare_exchange_strong(as, Progress::taken, std::memory_order_acquire)) {
        finish_with(k, *kept[k]);
        out.sheets.give_back(std::move(kept[k]));
      }
      return true;
    };
    shares.take(me, [&](std::uint32_t k) {
      const std::uint32_t number = in.due_chunks[k];
      const std::optional<std::uint32_t> next = k + 1 < count ? std::optional(in.due_chunks[k + 1]) : std::nullopt;
      evaluate_chunk<Law, Keep>(law, in, pairs, walls, number, next, kernel::ChunkOutput{*sheet, out.asked, in.chunks});
      std::atomic_ref(pairs.chunk[number].pending).store(0, std::memory_order_release);
      if (ready(k)) {
        progress[k].store(Progress::taken, std::memory_order_relaxed);
        finish_with(k, *sheet);
      } else {
        waiting.push_back(k);
        kept[k] = std::exchange(sheet, out.sheets.take());
        progress[k].store(Progress::waiting, std::memory_order_release);
      }
      std::erase_if(waiting, finish_if_ready);
    });
    // Awake until all is done, as at the end of the region OpenMP would soon put the thread to sleep, and waking it takes longer than others
    // need.
    wait_until([&] {
      std::erase_if(waiting, finish_if_ready);
      for (std::size_t k = 0; k < count; ++k) finish_if_ready(k);
      return finished == count;
    });
  }
  double largest_overlap = 0;
  for (const std::uint32_t number : in.due_chunks) {
    largest_overlap = std::max(largest_overlap, pairs.chunk[number].largest_overlap);
    for (const WallContacts::Chunk& chunk : std::as_const(walls).chunks_of(number)) {
      largest_overlap = std::max(largest_overlap, chunk.largest_overlap);
      if (chunk.overflow)
        throw PhysicsError("a grain touches wall '" + in.walls[chunk.wall].name + "' in more than " +
                           std::to_string(WallCandidate::capacity) +
                           " places; its mesh has details much smaller than the grains");
    }
  }
  return largest_overlap;
}

template <class Law>
double evaluate_all(const Law& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                    const ForceOutput& out, const FinishChunk& finish) {
  return keep_ledger ? evaluate_all<Law, true>(law, in, pairs, walls, out, finish)
                     : evaluate_all<Law, false>(law, in, pairs, walls, out, finish);
}

}  // namespace

double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         const ForceOutput& out, const FinishChunk& finish) {
  double overlap = 0;
  const bool compiled = [&]<class... Fixed>(std::type_identity<std::tuple<Fixed...>>) {
    return ((law == choice_of<Fixed>() && (overlap = evaluate_all(Fixed{}, keep_ledger, in, pairs, walls, out, finish), true)) || ...);
  }(std::type_identity<FixedLaws>{});
  return compiled ? overlap : evaluate_all(law, keep_ledger, in, pairs, walls, out, finish);
}

void book_second_half(const ForceInput& in, PairContacts& pairs, const WallContacts& walls) {
#pragma omp parallel for schedule(dynamic, 1) if (in.due_chunks.size() >= RowChunks::few)
  for (std::size_t n = 0; n < in.due_chunks.size(); ++n) {
    const std::uint32_t number = in.due_chunks[n];
    PairContacts::Chunk& chunk = pairs.chunk[number];
    chunk.ledger = LedgerSums{};
    for (std::uint32_t b = chunk.begin; b < chunk.end; ++b) {
      if (!pairs.activity[b].acts || pairs.activity[b].level > in.due) continue;
      for (std::size_t lane = PairContacts::width * b; lane < PairContacts::width * (b + 1); ++lane) {
        if (!pairs.acts(lane)) continue;
        const GrainRow &i = in.grains[pairs.first(lane)], &j = in.grains[pairs.second(lane)];
        chunk.ledger += half_of_work(pairs.last[lane], i.velocity() - j.velocity(), i.angular_velocity(), j.angular_velocity());
      }
    }
    for (const WallContacts::Chunk& of_wall : walls.chunks_of(number))
      for (std::uint32_t q = of_wall.begin; q < of_wall.end; ++q) {
        const WallCandidate& c = walls.candidate[q];
        const GrainRow& grain = in.grains[c.particle];
        for (std::size_t k = c.contact_begin; k < c.contact_begin + c.size && walls.activity[q].level <= in.due; ++k) {
          const LastForces& last = walls.last[k];
          if (walls.contact[k].acts()) chunk.ledger += half_of_work(last, grain.velocity(), grain.angular_velocity(), last.wall_spin);
        }
      }
  }
}

}  // namespace dem
