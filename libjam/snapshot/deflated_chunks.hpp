// Rows of an array in chunks that HDF5 stores through its filters shuffle and deflate, packed and unpacked by libdeflate, which takes less than half of the
// time of the zlib that HDF5 uses. The files are HDF5's own: its filters read what is written here, and the other way round.
//
// Shuffled, the low bytes of measured numbers are noise, which no code makes shorter: they are stored as they are, and only the bytes behind them, of the
// exponents, are coded. That is what takes time to unpack.
#pragma once
#include <hdf5.h>

#include <cstdint>

namespace jam::h5 {

// Fills `rows` with rows [start, start + count) of the dataset, whose elements are of the type `memory`. False, and `rows` then holds nothing of use, wherever
// this is not the plain case or anything looks odd: other filters, chunks that do not span a row, chunks that are not there or do not unpack. HDF5 itself
// then reads, or says what is wrong. Condition: the rows are there.
bool read_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t start, std::uint64_t count, void* rows);

// Writes rows [start, start + count), for which the dataset has room; a chunk that they do not fill is filled up with zeros. False wherever this is not the
// plain case: other filters or types, a start within a chunk, rows behind the last one in its chunk (`rows_before`: how many there were before room was
// made). HDF5 itself then writes all of them.
bool write_deflated_rows(hid_t dataset, hid_t memory, std::uint64_t rows_before, std::uint64_t start, std::uint64_t count, const void* rows);

}  // namespace jam::h5
