// Rows of an array in chunks that HDF5 stored through its filters shuffle and deflate, unpacked by libdeflate, which takes less than half of the time of the
// zlib that HDF5 uses.
#pragma once
#include <hdf5.h>

#include <cstdint>

namespace jam::h5 {

// Fills `rows` with rows [start, start + count) of the dataset, whose elements are of the type `memory`. False, and `rows` then holds nothing of use, wherever
// this is not the plain case or anything looks odd: other filters, chunks that do not span a row, chunks that are not there or do not unpack. HDF5 itself
// then reads, or says what is wrong. Condition: the rows are there.
bool read_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t start, std::uint64_t count, void* rows);

}  // namespace jam::h5
