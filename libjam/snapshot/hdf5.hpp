// A small value layer over the HDF5 C API: named arrays with unit and doc, attributes, growing columns.
//
//   h5::File f = h5::File::create("bed.h5");
//   f.write("/particles/position", positions, "m", "centres");      // std::vector of numbers, std::array or Eigen
//   vectors f.set_attribute("/", "seed", std::uint64_t{7}); f.close(); // throws if the disk did not take it auto
//   positions = h5::File::open("bed.h5").read<Eigen::Vector3d>("/particles/position");
//
// Rows are elements of a std::vector; an element with several components becomes the second dimension, [rows,
// components]. Whatever goes wrong is a DataError "FILE:/NAME: problem (HDF5's reason)"; HDF5 itself never prints.
// Sizes that a file claims are compared with the bytes it has before anything is allocated. Fixed arrays carry a
// Fletcher-32 checksum. A File is used by one thread at a time.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace jam::h5 {

// Element types, named as in NumPy. `text` is a fixed-length UTF-8 string.
enum class Type : std::uint8_t { i1, i2, i4, i8, u1, u2, u4, u8, f4, f8, text, other };
std::string name_of(Type type);

template <class T>
requires std::is_arithmetic_v<T> &&(!std::is_same_v<T, bool>)constexpr Type type_of() {
  if constexpr (std::is_floating_point_v<T>) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8, "no long double");
    return sizeof(T) == 4 ? Type::f4 : Type::f8;
  } else if constexpr (std::is_signed_v<T>) {
    return sizeof(T) == 1 ? Type::i1 : sizeof(T) == 2 ? Type::i2 : sizeof(T) == 4 ? Type::i4 : Type::i8;
  } else {
    return sizeof(T) == 1 ? Type::u1 : sizeof(T) == 2 ? Type::u2 : sizeof(T) == 4 ? Type::u4 : Type::u8;
  }
}

// One row: a number, a std::array of numbers or a fixed-size Eigen vector. width 1 for a plain number.
template <class T>
struct Row {
  static constexpr Type type = type_of<T>();
  static constexpr unsigned width = 1;
};
template <class S, std::size_t n>
struct Row<std::array<S, n>> {
  static constexpr Type type = type_of<S>();
  static constexpr unsigned width = n;
};
template <class S, int n, int options, int max_rows, int max_columns>
requires(n > 0) struct Row<Eigen::Matrix<S, n, 1, options, max_rows, max_columns>> {
  static constexpr Type type = type_of<S>();
  static constexpr unsigned width = n;
};
template <class E>
requires std::is_enum_v<E>
struct Row<E> {
  static constexpr Type type = type_of<std::underlying_type_t<E>>();
  static constexpr unsigned width = 1;
};

// What a stored array looks like. shape: [] scalar, [rows], [rows, components].
struct Layout {
  Type type = Type::other;
  std::vector<std::uint64_t> shape;
  std::uint64_t rows() const { return shape.empty() ? 1 : shape[0]; }
  std::uint64_t width() const { return shape.size() < 2 ? 1 : shape[1]; }
};

// A file that gets rows later is laid out so that a kill then leaves it readable; HDF5 notes the time of its making in it. One that is written
// at once is the same bytes for the same contents.
enum class Grows : std::uint8_t { no, yes };

class File {
 public:
  // A new, empty file in place of whatever is there.
  static File create(const std::filesystem::path& path, Grows grows = Grows::no);
  // Read only. Also opens files that another process is appending to, or that a killed one left unclosed.
  static File open(const std::filesystem::path& path);
  // Appends rows to existing columns so that readers see a consistent file at any moment (HDF5's SWMR mode). Nothing
  // can be created in this mode. Fails on a file that a killed process left unclosed.
  static File open_append(const std::filesystem::path& path);
  // Everything is allowed; a kill while the file is open so may destroy it.
  static File open_update(const std::filesystem::path& path);

  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();  // closes; use close() to learn whether that worked
  void close();
  void flush();
  const std::string& path() const { return path_; }

  bool exists(const std::string& name) const;
  bool is_group(const std::string& name) const;
  std::vector<std::string> children(const std::string& group) const;  // sorted by name
  Layout layout(const std::string& name) const;                       // throws if there is no such array
  std::uint64_t stored_bytes(const std::string& name) const;
  void make_group(const std::string& name);  // with its parents; may exist

  // Whole arrays, chunked, compressed and checksummed. Parent groups are made as needed.
  template <class T>
  void write(const std::string& name, const std::vector<T>& rows, const std::string& unit, const std::string& doc) {
    write_array(name, Row<T>::type, shape_of<T>(rows.size()), rows.data(), unit, doc);
  }
  // values[r * columns + c]
  template <class T>
  void write_matrix(const std::string& name, const std::vector<T>& values, std::uint64_t columns,
                    const std::string& unit, const std::string& doc) {
    write_array(name, type_of<T>(), {columns == 0 ? 0 : values.size() / columns, columns}, values.data(), unit, doc);
  }
  void write_text(const std::string& name, const std::string& text, const std::string& doc);
  void write_texts(const std::string& name, const std::vector<std::string>& texts, const std::string& doc);

  template <class T>
  std::vector<T> read(const std::string& name) const {
    return read_rows<T>(name, 0, layout(name).rows());
  }
  template <class T>
  std::vector<T> read_rows(const std::string& name, std::uint64_t start, std::uint64_t count) const {
    std::vector<T> rows;
    get_rows(name, Row<T>::type, Row<T>::width, start, count, [&]() -> void* {
      rows.resize(count);
      return rows.data();
    });
    return rows;
  }
  // Row-major values of a two-dimensional array; columns is set to its second dimension.
  template <class T>
  std::vector<T> read_matrix(const std::string& name, std::uint64_t& columns) const {
    const Layout stored = layout(name);
    columns = stored.width();
    std::vector<T> values;
    get_rows(name, type_of<T>(), columns, 0, stored.rows(), [&]() -> void* {
      values.resize(stored.rows() * columns);
      return values.data();
    });
    return values;
  }
  std::string read_text(const std::string& name) const;
  std::vector<std::string> read_texts(const std::string& name) const;

  // Growing columns. A chunk of a compressed column should be written once: start every batch of rows on a multiple of
  // chunk_rows. Columns that grow by single rows should not be compressed.
  template <class T>
  void make_column(const std::string& name, std::uint64_t chunk_rows, bool compressed, const std::string& unit,
                   const std::string& doc) {
    make_column(name, Row<T>::type, Row<T>::width, chunk_rows, compressed, unit, doc);
  }
  void make_column(const std::string& name, Type type, unsigned width, std::uint64_t chunk_rows, bool compressed,
                   const std::string& unit, const std::string& doc);
  // Writes rows [start, start + rows.size()), growing the column if it is shorter.
  template <class T>
  void write_rows(const std::string& name, std::uint64_t start, const std::vector<T>& rows) {
    put_rows(name, Row<T>::type, start, shape_of<T>(rows.size()), rows.data());
  }
  template <class T>
  void append(const std::string& name, const std::vector<T>& rows) {
    write_rows(name, layout(name).rows(), rows);
  }
  std::uint64_t chunk_rows(const std::string& name) const;  // 0 where the array is not chunked

  // Attributes of a group or array ("/" is the file itself); setting replaces. Numbers, vectors of numbers, strings.
  bool has_attribute(const std::string& object, const std::string& name) const;
  template <class T>
  void set_attribute(const std::string& object, const std::string& name, const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string>) {
      put_text_attribute(object, name, value);
    } else {
      put_attribute(object, name, Row<T>::type, Row<T>::width, &value);
    }
  }
  template <class T>
  T attribute(const std::string& object, const std::string& name) const {
    if constexpr (std::is_same_v<T, std::string>) {
      return get_text_attribute(object, name);
    } else {
      T value;
      get_attribute(object, name, Row<T>::type, Row<T>::width, &value);
      return value;
    }
  }
  std::vector<std::string> attributes(const std::string& object) const;  // sorted by name

  // Removes an array, a group with all that is in it, or an attribute, "/object@name".
  void remove(const std::string& name);

  // Throws DataError("FILE:place: problem").
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

 private:
  enum class Mode : std::uint8_t { create, create_growing, read, append, update };
  File(const std::filesystem::path& path, Mode mode);

  template <class T>
  static std::vector<std::uint64_t> shape_of(std::uint64_t rows) {
    static_assert(sizeof(T) % Row<T>::width == 0 && std::is_standard_layout_v<std::array<T, 1>>);
    if constexpr (Row<T>::width == 1) {
      return {rows};
    } else {
      return {rows, Row<T>::width};
    }
  }
  // Of an array that does not open.
  [[noreturn]] void fail_to_open(const std::string& name) const;
  void make_parents(const std::string& name);
  void write_array(const std::string& name, Type type, const std::vector<std::uint64_t>& shape, const void* data,
                   const std::string& unit, const std::string& doc);
  // Puts rows [start, start + count) where `room` says, which is asked once they are known to be of this type and width and the file to be large enough
  // to hold them; throws where they are not.
  void get_rows(const std::string& name, Type type, std::uint64_t width, std::uint64_t start, std::uint64_t count, const std::function<void*()>& room) const;
  void put_rows(const std::string& name, Type type, std::uint64_t start, const std::vector<std::uint64_t>& shape,
                const void* data);
  void put_attribute(const std::string& object, const std::string& name, Type type, unsigned width, const void* data);
  void get_attribute(const std::string& object, const std::string& name, Type type, unsigned width, void* data) const;
  void put_text_attribute(const std::string& object, const std::string& name, const std::string& text);
  std::string get_text_attribute(const std::string& object, const std::string& name) const;
  std::uint64_t largest_bytes(const std::string& name) const;

  std::string path_;
  std::int64_t id_ = -1;  // HDF5's handle
};

// Writes a whole file under a name beside `path` and renames it when it is complete, so that `path` holds either the
// old file or the new one.
void write_aside(const std::filesystem::path& path, const std::function<void(File&)>& fill, Grows grows = Grows::no);

// The name beside `path` under which a file is prepared.
std::filesystem::path aside_of(const std::filesystem::path& path);

// What the first bytes of a file tell about how it was left.
struct Condition {
  bool unclosed = false;          // a writer is at work, or was killed
  std::uint64_t bytes = 0;        // size of the file
  std::uint64_t least_bytes = 0;  // what it had when it was last closed; 0 if unknown
  bool cut_short() const { return bytes < least_bytes; }
};
Condition condition_of(const std::filesystem::path& path);

// True if the file begins as an HDF5 file does (no exception for missing or short files).
bool is_hdf5(const std::filesystem::path& path);

}  // namespace jam::h5
