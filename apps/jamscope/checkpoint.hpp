// The exact state of a run, float64, as a file: checkpoints to resume from, and settled beds to start from.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "libdem/bed/bed.hpp"
#include "libdem/simulation/simulation.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

struct Checkpoint {
  dem::State state;
  jam::Series pending;      // rows of /series since the last frame
  std::string case_sha256;  // of the case (with overrides) that the run belongs to
};

// Written aside and renamed: the path holds either the old checkpoint or the new one. Throws jam::DataError.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);
Checkpoint read_checkpoint(const std::string& path);

// Settled beds are kept under a name that is the SHA-256 of everything that determines them. The step of the run does not.
std::string bed_key(const dem::Setup& setup, const dem::Bed& bed, const dem::BedRegion& region);
void write_bed(const std::string& path, const dem::SettledBed& bed, const std::string& key);
// Nothing where there is no such file; throws jam::DataError where there is one that cannot be used.
std::optional<dem::SettledBed> read_bed(const std::string& path, const std::string& key);

// $XDG_CACHE_HOME/jamscope/beds or ~/.cache/jamscope/beds; empty where neither is set.
std::string default_bed_cache();

}  // namespace jamscope
