#include "libjam/snapshot/hdf5.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "libjam/errors.hpp"
#include "libjam/snapshot/deflated_chunks.hpp"

static_assert(std::is_same_v<hid_t, std::int64_t>, "HDF5 1.10 or newer");

namespace jam::h5 {
namespace {

// Deflate cannot do better than 1032 : 1, so a compressed array cannot be larger than that times its stored bytes.
constexpr std::uint64_t largest_deflate_ratio = 1032;
constexpr std::uint64_t small_array_bytes = std::uint64_t{1} << 16;  // allowed whatever the file's size

// HDF5 prints errors to stderr unless told otherwise; the setting is per thread, so it is put back.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  hid_t get() const { return id_; }
  bool ok() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// The innermost message of HDF5's error stack; for a failed system call the system's own words.
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        auto& best = *static_cast<std::string*>(out);
        if (best.empty() && error->desc != nullptr) best = error->desc;
        return 0;
      },
      &text);
  const std::string key = "error message = '";
  if (const auto at = text.find(key); at != std::string::npos) {
    const auto from = at + key.size();
    text = text.substr(from, text.find('\'', from) - from);
  }
  return text;
}

std::string with_reason(const std::string& problem) {
  const std::string why = reason();
  return why.empty() ? problem : problem + " (" + why + ")";
}

hid_t memory_type(Type type) {
  switch (type) {
    case Type::i1:
      return H5T_NATIVE_INT8;
    case Type::i2:
      return H5T_NATIVE_INT16;
    case Type::i4:
      return H5T_NATIVE_INT32;
    case Type::i8:
      return H5T_NATIVE_INT64;
    case Type::u1:
      return H5T_NATIVE_UINT8;
    case Type::u2:
      return H5T_NATIVE_UINT16;
    case Type::u4:
      return H5T_NATIVE_UINT32;
    case Type::u8:
      return H5T_NATIVE_UINT64;
    case Type::f4:
      return H5T_NATIVE_FLOAT;
    case Type::f8:
      return H5T_NATIVE_DOUBLE;
    case Type::text:
    case Type::other:
      break;
  }
  return H5I_INVALID_HID;
}

hid_t file_type(Type type) {
  switch (type) {
    case Type::i1:
      return H5T_STD_I8LE;
    case Type::i2:
      return H5T_STD_I16LE;
    case Type::i4:
      return H5T_STD_I32LE;
    case Type::i8:
      return H5T_STD_I64LE;
    case Type::u1:
      return H5T_STD_U8LE;
    case Type::u2:
      return H5T_STD_U16LE;
    case Type::u4:
      return H5T_STD_U32LE;
    case Type::u8:
      return H5T_STD_U64LE;
    case Type::f4:
      return H5T_IEEE_F32LE;
    case Type::f8:
      return H5T_IEEE_F64LE;
    case Type::text:
    case Type::other:
      break;
  }
  return H5I_INVALID_HID;
}

std::uint64_t size_of(Type type) {
  switch (type) {
    case Type::i1:
    case Type::u1:
      return 1;
    case Type::i2:
    case Type::u2:
      return 2;
    case Type::i4:
    case Type::u4:
    case Type::f4:
      return 4;
    default:
      return 8;
  }
}

Type stored_type(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return size == 4 ? Type::f4 : size == 8 ? Type::f8 : Type::other;
    case H5T_INTEGER: {
      const bool is_signed = H5Tget_sign(type) == H5T_SGN_2;
      switch (size) {
        case 1:
          return is_signed ? Type::i1 : Type::u1;
        case 2:
          return is_signed ? Type::i2 : Type::u2;
        case 4:
          return is_signed ? Type::i4 : Type::u4;
        case 8:
          return is_signed ? Type::i8 : Type::u8;
        default:
          return Type::other;
      }
    }
    case H5T_STRING:
      return H5Tis_variable_str(type) > 0 ? Type::other : Type::text;
    default:
      return Type::other;
  }
}

// Stored values may be converted on reading where that loses no more than float precision.
bool readable_as(Type stored, Type wanted) {
  const auto kind = [](Type t) { return t <= Type::i8 ? 0 : t <= Type::u8 ? 1 : t <= Type::f8 ? 2 : 3; };
  if (kind(stored) != kind(wanted) || kind(stored) == 3) return false;
  return kind(stored) == 2 || size_of(stored) <= size_of(wanted);
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

// Cuts the padding off.
std::string trimmed(const char* data, std::size_t length) {
  while (length > 0 && data[length - 1] == '\0') --length;
  return {data, length};
}

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  // A viewer that holds the file open must not stop the simulation that appends to it, and file locks do not exist on
  // every file system.
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  H5Pset_file_locking(access.get(), false, true);
#endif
  return access;
}

// A kill during a write leaves a whole number of the kernel's pages. The file's own bookkeeping, rewritten in place with
// every frame, must therefore not lie across two of them: half new and half old it fails its checksum, and all frames
// of the column are lost. With this strategy HDF5 lets nothing smaller than a page cross the boundary of one.
void keep_metadata_within_pages(hid_t plan) {
  constexpr hsize_t page_bytes = 4096;
  H5Pset_file_space_strategy(plan, H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(plan, page_bytes);
}

Handle utf8_links() {
  Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_char_encoding(links.get(), H5T_CSET_UTF8);
  return links;
}

// How to make an object: without the times of its making, so that the same contents are the same bytes.
Handle timeless(hid_t kind) {
  Handle plan(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(plan.get(), false);
  return plan;
}

Handle open_dataset(hid_t file, const std::string& name) {
  return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
}

Handle open_object(hid_t file, const std::string& name) {
  return {H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose};
}

std::optional<std::vector<hsize_t>> shape_of_space(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || H5Sget_simple_extent_type(space) == H5S_NULL) return std::nullopt;
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (rank > 0 && H5Sget_simple_extent_dims(space, shape.data(), nullptr) < 0) return std::nullopt;
  return shape;
}

std::optional<Layout> layout_of(const Handle& dataset) {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const auto shape = space.ok() ? shape_of_space(space.get()) : std::nullopt;
  if (!shape || !type.ok()) return std::nullopt;
  return Layout{stored_type(type.get()), {shape->begin(), shape->end()}};
}

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

}  // namespace

std::string name_of(Type type) {
  switch (type) {
    case Type::i1:
      return "i1";
    case Type::i2:
      return "i2";
    case Type::i4:
      return "i4";
    case Type::i8:
      return "i8";
    case Type::u1:
      return "u1";
    case Type::u2:
      return "u2";
    case Type::u4:
      return "u4";
    case Type::u8:
      return "u8";
    case Type::f4:
      return "f4";
    case Type::f8:
      return "f8";
    case Type::text:
      return "text";
    case Type::other:
      break;
  }
  return "other";
}

void File::fail(const std::string& place, const std::string& problem) const {
  throw DataError(path_ + ":" + place + ": " + problem);
}

File::File(const std::filesystem::path& path, Mode mode) : path_(path.string()) {
  // A badly damaged file can leave something open inside HDF5, whose clean-up at exit then complains on stderr. Our
  // files are closed by their destructors, so that clean-up has nothing to do for us.
  [[maybe_unused]] static const herr_t no_cleanup_at_exit = H5dont_atexit();
  const Quiet quiet;
  const Handle access = file_access(), plan(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  if (mode == Mode::create_growing) keep_metadata_within_pages(plan.get());
  H5Pset_obj_track_times(plan.get(), false);
  std::string verb = "open for reading";
  if (mode != Mode::create && mode != Mode::create_growing) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw DataError(path_ + ": no such file");
    if (!std::filesystem::is_regular_file(path, error)) throw DataError(path_ + ": is not a file");
    if (!is_hdf5(path)) throw DataError(path_ + ": is not an HDF5 file");
  }
  switch (mode) {
    case Mode::create:
    case Mode::create_growing:
      verb = "create";
      id_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, plan.get(), access.get());
      break;
    case Mode::read: {
      // Where the file is open elsewhere in this process already (h5py beside the Python module), both must close it in the same way.
      H5Pset_fclose_degree(access.get(), H5F_CLOSE_DEFAULT);
      // Metadata that a writer is just changing is read again, after 1, 2, 4, ... ns plus the system's latency; HDF5's
      // own limit of 100 attempts would wait for minutes where the file is damaged.
      H5Pset_metadata_read_attempts(access.get(), 16);
      // Let a file that was cut short be opened for what is left of it; reading past its end still fails. HDF5's own
      // tools use this property; a version without it refuses such a file.
      const hbool_t skip = true;
      H5Pset(access.get(), "skip_eof_check", &skip);
      // Without a writer, SWMR reading is plain reading; with one, or after one was killed, nothing else opens the
      // file.
      id_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.get());
      // Files by other programs with an older superblock know no SWMR.
      if (id_ < 0) {
        const std::string why = reason();
        id_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
        if (id_ < 0) throw DataError(path_ + ": cannot open for reading (" + why + ")");
      }
      break;
    }
    case Mode::append:
      verb = "open for appending";
      id_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, access.get());
      break;
    case Mode::update:
      verb = "open for writing";
      id_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, access.get());
      break;
  }
  if (id_ < 0) throw DataError(path_ + ": " + with_reason("cannot " + verb));
}

File File::create(const std::filesystem::path& path, Grows grows) {
  return {path, grows == Grows::yes ? Mode::create_growing : Mode::create};
}
File File::open(const std::filesystem::path& path) {
  return {path, Mode::read};
}
File File::open_append(const std::filesystem::path& path) {
  return {path, Mode::append};
}
File File::open_update(const std::filesystem::path& path) {
  return {path, Mode::update};
}

File::File(File&& other) noexcept : path_(std::move(other.path_)), id_(std::exchange(other.id_, -1)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(id_, other.id_);
  return *this;
}

File::~File() {
  if (id_ < 0) return;
  const Quiet quiet;
  H5Fclose(id_);
}

void File::close() {
  if (id_ < 0) return;
  const Quiet quiet;
  const hid_t id = std::exchange(id_, -1);
  if (H5Fclose(id) < 0) throw DataError(path_ + ": " + with_reason("cannot be written to the end"));
}

void File::flush() {
  const Quiet quiet;
  if (H5Fflush(id_, H5F_SCOPE_LOCAL) < 0) throw DataError(path_ + ": " + with_reason("cannot write"));
}

bool File::exists(const std::string& name) const {
  const Quiet quiet;
  if (name.empty() || name == "/") return true;
  // HDF5 wants every parent to exist before it can be asked about the child.
  for (std::size_t at = name.find('/', 1);; at = name.find('/', at + 1)) {
    const std::string part = name.substr(0, at);
    if (part.back() != '/') {
      if (H5Lexists(id_, part.c_str(), H5P_DEFAULT) <= 0) return false;
      if (H5Oexists_by_name(id_, part.c_str(), H5P_DEFAULT) <= 0) return false;
    }
    if (at == std::string::npos) return true;
  }
}

bool File::is_group(const std::string& name) const {
  const Quiet quiet;
  const Handle object = open_object(id_, name);
  return object.ok() && H5Iget_type(object.get()) == H5I_GROUP;
}

std::vector<std::string> File::children(const std::string& group) const {
  const Quiet quiet;
  std::vector<std::string> names;
  const Handle object = open_object(id_, group);
  if (!object.ok() || H5Iget_type(object.get()) != H5I_GROUP) fail(group, with_reason("no such group"));
  hsize_t index = 0;
  if (H5Literate(object.get(), H5_INDEX_NAME, H5_ITER_INC, &index, collect_name, &names) < 0) {
    fail(group, with_reason("cannot list"));
  }
  std::sort(names.begin(), names.end());
  return names;
}

Layout File::layout(const std::string& name) const {
  const Quiet quiet;
  const Handle dataset = open_dataset(id_, name);
  if (!dataset.ok()) fail_to_open(name);
  const auto stored = layout_of(dataset);
  if (!stored) fail(name, with_reason("has no readable shape"));
  return *stored;
}

void File::fail_to_open(const std::string& name) const {
  const std::string problem = with_reason("is not a readable array");
  fail(name, exists(name) ? problem : "missing");
}

std::uint64_t File::stored_bytes(const std::string& name) const {
  const Quiet quiet;
  const Handle dataset = open_dataset(id_, name);
  if (!dataset.ok()) fail(name, with_reason("is not a readable array"));
  return H5Dget_storage_size(dataset.get());
}

std::uint64_t File::chunk_rows(const std::string& name) const {
  const Quiet quiet;
  const Handle dataset = open_dataset(id_, name);
  if (!dataset.ok()) fail(name, with_reason("is not a readable array"));
  const Handle plan(H5Dget_create_plist(dataset.get()), H5Pclose);
  if (!plan.ok() || H5Pget_layout(plan.get()) != H5D_CHUNKED) return 0;
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  return H5Pget_chunk(plan.get(), H5S_MAX_RANK, chunk.data()) < 1 ? 0 : chunk[0];
}

// How many bytes the array can hold, judged by what is stored of it.
std::uint64_t File::largest_bytes(const std::string& name) const {
  std::error_code error;
  const std::uintmax_t file_bytes = std::filesystem::file_size(path_, error);
  if (error) fail(name, "cannot tell the size of the file: " + error.message());
  const std::uint64_t stored = std::min<std::uint64_t>(stored_bytes(name), file_bytes);
  if (stored > std::numeric_limits<std::uint64_t>::max() / (2 * largest_deflate_ratio)) return stored;
  return (chunk_rows(name) > 0 ? stored * largest_deflate_ratio : stored) + small_array_bytes;
}

// Not by HDF5, which would note when it made them.
void File::make_parents(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  if (slash != std::string::npos && slash > 0) make_group(name.substr(0, slash));
}

void File::make_group(const std::string& name) {
  const Quiet quiet;
  if (exists(name)) {
    if (!is_group(name)) fail(name, "is an array, expected a group");
    return;
  }
  make_parents(name);
  const Handle links = utf8_links();
  const Handle plan = timeless(H5P_GROUP_CREATE);
  const Handle group(H5Gcreate2(id_, name.c_str(), links.get(), plan.get(), H5P_DEFAULT), H5Gclose);
  if (!group.ok()) fail(name, with_reason("cannot make the group"));
}

void File::write_array(const std::string& name, Type type, const std::vector<std::uint64_t>& shape, const void* data,
                       const std::string& unit, const std::string& doc) {
  {
    const Quiet quiet;
    const std::vector<hsize_t> dims(shape.begin(), shape.end());
    const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
    const Handle plan = timeless(H5P_DATASET_CREATE);
    const std::uint64_t cells = shape[0] * (shape.size() > 1 ? shape[1] : 1);
    if (cells > 0) {
      std::vector<hsize_t> chunk = dims;
      const std::uint64_t row_bytes = std::max<std::uint64_t>(1, cells / shape[0] * size_of(type));
      chunk[0] = std::clamp<hsize_t>((hsize_t{1} << 20) / row_bytes, 1, shape[0]);
      H5Pset_chunk(plan.get(), static_cast<int>(chunk.size()), chunk.data());
      H5Pset_fletcher32(plan.get());
      H5Pset_shuffle(plan.get());
      H5Pset_deflate(plan.get(), 1);
    }
    make_parents(name);
    const Handle links = utf8_links();
    const Handle dataset(
        H5Dcreate2(id_, name.c_str(), file_type(type), space.get(), links.get(), plan.get(), H5P_DEFAULT), H5Dclose);
    if (!dataset.ok()) fail(name, with_reason("cannot make the array"));
    if (cells > 0 && H5Dwrite(dataset.get(), memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
      fail(name, with_reason("cannot write"));
    }
  }
  set_attribute(name, "unit", unit);
  set_attribute(name, "doc", doc);
}

void File::write_text(const std::string& name, const std::string& text, const std::string& doc) {
  {
    const Quiet quiet;
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle type = text_type(text.size());
    make_parents(name);
    const Handle links = utf8_links();
    const Handle plan = timeless(H5P_DATASET_CREATE);
    const Handle dataset(H5Dcreate2(id_, name.c_str(), type.get(), space.get(), links.get(), plan.get(), H5P_DEFAULT), H5Dclose);
    if (!dataset.ok()) fail(name, with_reason("cannot make the text"));
    if (H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) < 0) {
      fail(name, with_reason("cannot write"));
    }
  }
  set_attribute(name, "unit", "1");
  set_attribute(name, "doc", doc);
}

void File::write_texts(const std::string& name, const std::vector<std::string>& texts, const std::string& doc) {
  {
    const Quiet quiet;
    std::size_t length = 1;
    for (const std::string& text : texts) length = std::max(length, text.size());
    std::string block(length * texts.size(), '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(block.data() + i * length, length);
    const hsize_t rows = texts.size();
    const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
    const Handle type = text_type(length);
    make_parents(name);
    const Handle links = utf8_links();
    const Handle plan = timeless(H5P_DATASET_CREATE);
    const Handle dataset(H5Dcreate2(id_, name.c_str(), type.get(), space.get(), links.get(), plan.get(), H5P_DEFAULT), H5Dclose);
    if (!dataset.ok()) fail(name, with_reason("cannot make the array"));
    if (rows > 0 && H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()) < 0) {
      fail(name, with_reason("cannot write"));
    }
  }
  set_attribute(name, "unit", "1");
  set_attribute(name, "doc", doc);
}

void File::get_rows(const std::string& name, Type type, std::uint64_t width, std::uint64_t start, std::uint64_t count,
                    const std::function<void*()>& room) const {
  const Quiet quiet;
  const Handle dataset = open_dataset(id_, name);
  if (!dataset.ok()) fail_to_open(name);
  const auto layout = layout_of(dataset);
  if (!layout) fail(name, with_reason("has no readable shape"));
  const Layout& stored = *layout;
  if (!readable_as(stored.type, type)) {
    fail(name, "has elements of type " + name_of(stored.type) + ", expected " + name_of(type));
  }
  if (stored.shape.size() > 2 || stored.width() != width) {
    fail(name, "has " + std::to_string(stored.width()) + " components in " + std::to_string(stored.shape.size()) +
                   " dimensions, expected " + std::to_string(width) + (width > 1 ? " in 2" : " in 1"));
  }
  if (count > stored.rows() || start > stored.rows() - count) {
    fail(name, "has " + std::to_string(stored.rows()) + " rows, expected at least " + std::to_string(start) + " + " +
                   std::to_string(count));
  }
  const Handle plan(H5Dget_create_plist(dataset.get()), H5Pclose);
  const bool chunked = plan.ok() && H5Pget_layout(plan.get()) == H5D_CHUNKED;
  const std::uint64_t row_bytes = size_of(type) * std::max<std::uint64_t>(width, 1);
  // What a chunked array holds is the sum over all its chunks. To ask for less than the file's own size does no harm, and the sum is not worth it.
  std::error_code error;
  const std::uintmax_t file_bytes = std::filesystem::file_size(path_, error);
  if (error || !chunked || count > file_bytes / row_bytes) {
    const std::uint64_t limit = largest_bytes(name);
    if (count > limit / size_of(stored.type) || count > std::numeric_limits<std::int64_t>::max() / row_bytes ||
        count * std::max<std::uint64_t>(width, 1) * size_of(stored.type) > limit) {
      fail(name, "claims " + std::to_string(count) + " rows of " + std::to_string(row_bytes) + " bytes, but only " +
                     std::to_string(stored_bytes(name)) + " bytes are stored");
    }
  }
  void* const data = room();
  if (count == 0) return;
  if (chunked && read_deflated_rows(dataset.get(), memory_type(type), start, count, data)) return;
  herr_t status = -1;
  if (stored.shape.empty()) {
    status = H5Dread(dataset.get(), memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  } else {
    const int rank = int(stored.shape.size());
    const std::array<hsize_t, 2> offset{start, 0}, extent{count, stored.width()};
    const Handle space(H5Dget_space(dataset.get()), H5Sclose), memory(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, offset.data(), nullptr, extent.data(), nullptr) >= 0)
      status = H5Dread(dataset.get(), memory_type(type), memory.get(), space.get(), H5P_DEFAULT, data);
  }
  if (status < 0) fail(name, with_reason("cannot read " + std::to_string(count) + " rows from row " + std::to_string(start)));
}

std::string File::read_text(const std::string& name) const {
  const Quiet quiet;
  const Layout stored = layout(name);
  if (stored.type != Type::text || !stored.shape.empty()) fail(name, "is not a text");
  const Handle dataset = open_dataset(id_, name);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const std::size_t length = H5Tget_size(type.get());
  if (length > largest_bytes(name)) fail(name, "claims " + std::to_string(length) + " bytes, more than the file has");
  std::string text(length, '\0');
  const Handle memory = text_type(length);
  if (H5Dread(dataset.get(), memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) {
    fail(name, with_reason("cannot read"));
  }
  return trimmed(text.data(), length);
}

std::vector<std::string> File::read_texts(const std::string& name) const {
  const Quiet quiet;
  const Layout stored = layout(name);
  if (stored.type != Type::text || stored.shape.size() != 1) fail(name, "is not a list of texts");
  const Handle dataset = open_dataset(id_, name);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const std::size_t length = H5Tget_size(type.get());
  const std::uint64_t limit = largest_bytes(name);
  if (length == 0 || stored.rows() > limit / length) {
    fail(name, "claims " + std::to_string(stored.rows()) + " texts of " + std::to_string(length) +
                   " bytes, more than the file has");
  }
  std::string block(length * stored.rows(), '\0');
  const Handle memory = text_type(length);
  if (!block.empty() && H5Dread(dataset.get(), memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()) < 0) {
    fail(name, with_reason("cannot read"));
  }
  std::vector<std::string> texts;
  for (std::uint64_t i = 0; i < stored.rows(); ++i) texts.push_back(trimmed(block.data() + i * length, length));
  return texts;
}

void File::make_column(const std::string& name, Type type, unsigned width, std::uint64_t chunk_rows, bool compressed,
                       const std::string& unit, const std::string& doc) {
  {
    const Quiet quiet;
    const int rank = width > 1 ? 2 : 1;
    const std::array<hsize_t, 2> none{0, width}, any{H5S_UNLIMITED, width};
    const std::array<hsize_t, 2> chunk{std::max<std::uint64_t>(chunk_rows, 1), width};
    const Handle space(H5Screate_simple(rank, none.data(), any.data()), H5Sclose);
    const Handle plan = timeless(H5P_DATASET_CREATE);
    H5Pset_chunk(plan.get(), rank, chunk.data());
    if (compressed) {
      H5Pset_shuffle(plan.get());
      H5Pset_deflate(plan.get(), 1);
    }
    make_parents(name);
    const Handle links = utf8_links();
    const Handle dataset(
        H5Dcreate2(id_, name.c_str(), file_type(type), space.get(), links.get(), plan.get(), H5P_DEFAULT), H5Dclose);
    if (!dataset.ok()) fail(name, with_reason("cannot make the column"));
  }
  set_attribute(name, "unit", unit);
  set_attribute(name, "doc", doc);
}

void File::put_rows(const std::string& name, Type type, std::uint64_t start, const std::vector<std::uint64_t>& shape,
                    const void* data) {
  const Quiet quiet;
  if (shape[0] == 0) return;
  const Layout stored = layout(name);
  if (stored.type != type || stored.shape.size() != shape.size() || (shape.size() > 1 && stored.shape[1] != shape[1])) {
    fail(name, "has elements of type " + name_of(stored.type) + " and " + std::to_string(stored.width()) +
                   " components, cannot take " + name_of(type) + " with " +
                   std::to_string(shape.size() > 1 ? shape[1] : 1));
  }
  const Handle dataset = open_dataset(id_, name);
  std::vector<hsize_t> count(shape.begin(), shape.end()), offset(shape.size(), 0);
  offset[0] = start;
  if (start + shape[0] > stored.rows()) {
    std::vector<hsize_t> extent = count;
    extent[0] = start + shape[0];
    if (H5Dset_extent(dataset.get(), extent.data()) < 0) fail(name, with_reason("cannot grow"));
  }
  if (!write_deflated_rows(dataset.get(), memory_type(type), stored.rows(), start, shape[0], data)) {
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(dataset.get(), memory_type(type), memory.get(), space.get(), H5P_DEFAULT, data) < 0) {
      fail(name, with_reason("cannot write"));
    }
  }
  if (H5Dflush(dataset.get()) < 0) fail(name, with_reason("cannot write"));
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
  const Quiet quiet;
  return exists(object) && H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> File::attributes(const std::string& object) const {
  const Quiet quiet;
  std::vector<std::string> names;
  hsize_t index = 0;
  if (H5Aiterate_by_name(id_, object.c_str(), H5_INDEX_NAME, H5_ITER_INC, &index, collect_attribute, &names,
                         H5P_DEFAULT) < 0) {
    fail(object, with_reason("cannot list the attributes"));
  }
  std::sort(names.begin(), names.end());
  return names;
}

void File::put_attribute(const std::string& object, const std::string& name, Type type, unsigned width,
                         const void* data) {
  const Quiet quiet;
  if (has_attribute(object, name)) H5Adelete_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT);
  const hsize_t extent = width;
  const Handle space(width == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const Handle attribute(H5Acreate_by_name(id_, object.c_str(), name.c_str(), file_type(type), space.get(), H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.ok() || H5Awrite(attribute.get(), memory_type(type), data) < 0) {
    fail(object + "@" + name, with_reason("cannot write the attribute"));
  }
}

void File::get_attribute(const std::string& object, const std::string& name, Type type, unsigned width,
                         void* data) const {
  const Quiet quiet;
  const std::string place = object + "@" + name;
  if (!has_attribute(object, name)) fail(place, "missing attribute");
  const Handle attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.ok()) fail(place, with_reason("cannot read the attribute"));
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(width)) {
    fail(place, "has " + std::to_string(H5Sget_simple_extent_npoints(space.get())) + " values, expected " +
                    std::to_string(width));
  }
  if (!readable_as(stored_type(stored.get()), type)) {
    fail(place, "is of type " + name_of(stored_type(stored.get())) + ", expected " + name_of(type));
  }
  if (H5Aread(attribute.get(), memory_type(type), data) < 0) fail(place, with_reason("cannot read the attribute"));
}

void File::put_text_attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Quiet quiet;
  if (has_attribute(object, name)) H5Adelete_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle type = text_type(text.size());
  const Handle attribute(H5Acreate_by_name(id_, object.c_str(), name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.ok() || H5Awrite(attribute.get(), type.get(), text.c_str()) < 0) {
    fail(object + "@" + name, with_reason("cannot write the attribute"));
  }
}

std::string File::get_text_attribute(const std::string& object, const std::string& name) const {
  const Quiet quiet;
  const std::string place = object + "@" + name;
  if (!has_attribute(object, name)) fail(place, "missing attribute");
  const Handle attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.ok()) fail(place, with_reason("cannot read the attribute"));
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  const std::size_t length = H5Tget_size(stored.get());
  std::error_code error;
  const std::uintmax_t file_bytes = std::filesystem::file_size(path_, error);
  if (stored_type(stored.get()) != Type::text || H5Sget_simple_extent_npoints(space.get()) != 1 || error ||
      length > file_bytes) {
    fail(place, "is not a text");
  }
  std::string text(length, '\0');
  const Handle memory = text_type(length);
  if (H5Aread(attribute.get(), memory.get(), text.data()) < 0) fail(place, with_reason("cannot read the attribute"));
  return trimmed(text.data(), length);
}

void File::remove(const std::string& name) {
  const Quiet quiet;
  const auto at = name.find('@');
  const herr_t status = at == std::string::npos ? H5Ldelete(id_, name.c_str(), H5P_DEFAULT)
                                                : H5Adelete_by_name(id_, name.substr(0, at).c_str(),
                                                                    name.substr(at + 1).c_str(), H5P_DEFAULT);
  if (status < 0) fail(name, with_reason("cannot remove"));
}

std::filesystem::path aside_of(const std::filesystem::path& path) {
  std::filesystem::path aside = path;
  aside += ".part";
  return aside;
}

void write_aside(const std::filesystem::path& path, const std::function<void(File&)>& fill, Grows grows) {
  const std::filesystem::path aside = aside_of(path);
  std::error_code error;
  try {
    File file = File::create(aside, grows);
    fill(file);
    file.close();
  } catch (...) {
    std::filesystem::remove(aside, error);
    throw;
  }
  std::filesystem::rename(aside, path, error);
  if (error) throw DataError(path.string() + ": cannot put the new file in place: " + error.message());
}

Condition condition_of(const std::filesystem::path& path) {
  Condition condition;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error) condition.bytes = bytes;
  // Superblock versions 2 and 3 (HDF5 file format specification, II.A): signature 8, version, size of offsets, size of
  // lengths, consistency flags, base address 8, extension address 8, end of file address 8 bytes.
  std::array<unsigned char, 36> start{};
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  if (in.gcount() != start.size() || !is_hdf5(path) || start[8] < 2 || start[8] > 3 || start[9] != 8) return condition;
  condition.unclosed = (start[11] & 1U) != 0;
  for (std::size_t k = 0; k < 8; ++k) condition.least_bytes |= std::uint64_t{start[28 + k]} << (8 * k);
  return condition;
}

bool is_hdf5(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 8> start{};
  in.read(start.data(), start.size());
  return in.gcount() == 8 && std::memcmp(start.data(), "\x89HDF\r\n\x1a\n", 8) == 0;
}

}  // namespace jam::h5
