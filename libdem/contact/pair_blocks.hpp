// From a list of pairs to blocks of contacts.
#pragma once
#include <array>
#include <functional>
#include <optional>

#include "libdem/contact/contact_store.hpp"
#include "libdem/neighbors/pair_list.hpp"

namespace dem {

// The grains as the blocks need them, in the order of their rows.
struct GrainTable {
  const LargeArray<GrainRow>& rows;  // and the phantoms behind them
  const std::vector<std::uint8_t>& material;
  std::size_t size() const { return material.size(); }
};

// Rows of the first and of the second grain, lane by lane, whole blocks.
using Lanes = std::vector<std::array<std::uint32_t, 2>>;

// Puts the pairs into lanes. All lanes of a block are of one chunk, one pair of materials, and all or none cross to
// another chunk. Those that touch (`level(i, j)`, nothing for others) come first, those of one level together, and share no
// block with those that do not, which go by their gap, so that what is far apart can be left alone together.
using LevelOf = std::function<std::optional<std::uint8_t>(std::uint32_t, std::uint32_t)>;
Lanes order_lanes(const PairList& list, const GrainTable& grains, std::size_t materials, const LevelOf& level);

// Are these lanes such as order_lanes() makes, whatever the order of the pairs within a kind and whatever touches?
bool fit(const Lanes& lanes, const GrainTable& grains);

// Blocks of such lanes, without memory. Condition: they fit. `used` are blocks that nobody needs any longer: their room is taken.
PairContacts make_pair_contacts(const Lanes& lanes, const GrainTable& grains, const MaterialTable& materials,
                                const Resolution& resolution, bool rolling_spring, bool keep_ledger, PairContacts used = {});

// Of a lane; where the second grain is a phantom, as if it were like the first.
PairConstants<double> constants_of(const PairContacts& pairs, std::size_t lane, const LargeArray<GrainRow>& rows, std::size_t grains,
                                   const MaterialTable& materials);

// What level 0 resolves of a block, the smallest of its lanes.
LevelScale scale_of(const PairContacts& pairs, std::size_t block, const GrainTable& grains, const MaterialTable& materials,
                    const Resolution& resolution);

// Fills in, from the pairs in blocks that cross to other chunks, where their second grains find what acts on them.
void connect_chunks(PairContacts& pairs, std::size_t grains);

}  // namespace dem
