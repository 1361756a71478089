// What a Simulation is made of, and how its parts work together in a step. engine.cpp has the steps, engine_lists.cpp the lists of what may
// touch and how a state remembers them, simulation.cpp what callers may ask for.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/contact/forces.hpp"
#include "libdem/simulation/contact_memory.hpp"
#include "libdem/simulation/force_watch.hpp"
#include "libdem/simulation/foresight.hpp"
#include "libdem/simulation/grain_store.hpp"
#include "libdem/simulation/guards.hpp"
#include "libdem/simulation/simulation.hpp"
#include "libdem/simulation/wall_books.hpp"

namespace dem {

struct Simulation::Engine {
  Engine(Setup s, State state);

  void advance(std::uint64_t steps);

  std::size_t size() const { return grains.size(); }
  double time() const { return double(step) * setup.step; }
  double kinetic_energy() const;
  Ledger ledger() const;
  GuardInput guarded() const { return {setup, grains.id, grains.rows, grains.mass, grains.inertia, materials, pairs, walls, time()}; }
  State::Layout layout() const;
  void begin_window();

  const Setup setup;
  const MaterialTable materials;
  std::uint64_t step;
  GrainStore grains;
  std::vector<WallPose> poses;
  PairContacts pairs;
  WallContacts walls;
  ForceSheets sheets;
  Foresight foresight;
  ForceWatch watch;
  WallBooks books;
  Effort effort;
  Window window;  // but for what is known only when it is taken

  LedgerSums spent;
  double initial_energy = 0;  // J

 private:
  // Steps.
  void begin();
  void go_on(const State& state);
  std::uint64_t stride_of_all() const { return std::uint64_t{1} << setup.levels; }
  bool all_due() const { return due == setup.levels; }
  void move_walls();
  void find_due();
  ForceInput force_input(bool look, bool record) const;
  double evaluate_with(bool look, bool record, const FinishChunk& finish);
  void evaluate(bool look, bool record, bool move);
  MotionColumns columns();
  template <bool Levels>
  void finish_chunk(std::size_t d, ForceSheet& forces, bool move);
  void keep_forces(std::uint32_t chunk, ForceSheet& forces);
  void move_all();
  template <class F>
  void for_each_due_wall_chunk(F f) const {
    for (const std::uint32_t c : due_chunks)
      for (const WallContacts::Chunk& chunk : walls.chunks_of(c)) f(chunk);
  }
  void book_first_half();
  void book_second_half();
  void count_evaluations();
  [[noreturn]] void stop();
  void guard() const;

  // Lists.
  ListInput list_input() const { return {setup, materials, poses, skin}; }
  void lay_out_rows(std::vector<std::uint32_t> order);
  void build_lists(const Memory& memory, const std::vector<double>& far);
  void fill_lists(const Lanes& lanes, const Memory& memory);
  void restore_lists(const State::Layout& layout, const Memory& memory);
  void restore_levels(const State::Layout& layout);
  bool lists_may_be_used_up() const { return !(foresight.odometer + foresight.travel_until_all_due() < next_look); }
  void renew_lists();
  bool regrouping_is_due() const;
  void adapt_skin();
  double travel(std::size_t r) const;
  std::vector<double> travelled() const;
  double skin_left() const;
  double too_little_left() const;
  double thinnest_skin() const { return 0.05 * mean_radius; }  // m
  double thickest_skin() const { return 0.8 * mean_radius; }   // m, with which test C in flow takes 1.2 kB a grain

  std::uint8_t due = 0;                   // the highest level that is, at this step
  std::vector<std::uint8_t> chunk_level;  // the finest of the grains' in each chunk
  std::vector<std::uint32_t> due_chunks;
  double mean_radius = 1, skin = 0;  // m
  std::uint64_t listed_step = 0;
  double next_look = 0;  // m, on the odometer: when to look how much of the skin is left
};

}  // namespace dem
