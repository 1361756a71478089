// Numbers of the libraries as NumPy arrays, without copying them: an array refers to the memory of the C++ object and keeps the Python object that
// owns it alive. It is read-only, and stays so: other arrays, other threads and the metrics kept of a frame read the same memory.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "libjam/results_tables.hpp"

namespace jamscope::python {

namespace py = pybind11;

// What a row of an array is made of.
template <class T>
struct Row {
  using Scalar = T;
  static constexpr py::ssize_t width = 1;
};
template <class T, std::size_t n>
struct Row<std::array<T, n>> {
  using Scalar = T;
  static constexpr py::ssize_t width = n;
};
template <class T, int n>
struct Row<Eigen::Matrix<T, n, 1>> {
  using Scalar = T;
  static constexpr py::ssize_t width = n;
};

inline py::array read_only(const py::dtype& type, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const void* data, py::handle owner) {
  static const double nothing = 0;  // an array of no rows has an owner too
  py::array a(type, std::move(shape), std::move(strides), data != nullptr ? data : &nothing, owner);
  py::detail::array_proxy(a.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return a;
}

// [rows] or [rows, width].
template <class T>
py::array view(const T* data, std::size_t rows, py::handle owner) {
  using R = Row<T>;
  static_assert(sizeof(T) == R::width * sizeof(typename R::Scalar));
  const auto type = py::dtype::of<typename R::Scalar>();
  const py::ssize_t size = sizeof(T), n = py::ssize_t(rows);
  if constexpr (R::width == 1) return read_only(type, {n}, {size}, data, owner);
  return read_only(type, {n, R::width}, {size, py::ssize_t(sizeof(typename R::Scalar))}, data, owner);
}
template <class T>
py::array view(const std::vector<T>& values, py::handle owner) {
  return view(values.data(), values.size(), owner);
}

// [3].
inline py::array view(const Eigen::Vector3d& v, py::handle owner) { return view(v.data(), 3, owner); }

// Numbers that nothing else owns; the array may be written.
template <class T>
py::array owned(std::vector<T> values) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  return py::array(py::dtype::of<T>(), {py::ssize_t(kept->size())}, {py::ssize_t(sizeof(T))}, kept->data(), owner);
}

// The columns of a table of libjam/results_tables.hpp within its structs: names, types, and where each stands.
struct Columns {
  py::list names, types, offsets;
  template <class Struct, class T>
  void add(const char* name, T Struct::*member, std::size_t offset_of_struct = 0) {
    static const Struct sample{};
    const auto* const begin = reinterpret_cast<const char*>(&sample);
    names.append(name);
    offsets.append(std::size_t(reinterpret_cast<const char*>(&(sample.*member)) - begin) + offset_of_struct);
    const auto scalar = py::dtype::of<typename Row<T>::Scalar>();
    if constexpr (Row<T>::width == 1)
      types.append(scalar);
    else
      types.append(py::make_tuple(scalar, Row<T>::width));
  }
};

// A structured array over the structs themselves. `Struct`, whose columns are listed, stands at `offset` in each element; `more` adds columns.
template <class Struct, class Element, class More>
py::array table(const std::vector<Element>& rows, py::handle owner, std::size_t offset, More more) {
  Columns columns;
  more(columns);
  jam::columns_of(static_cast<Struct*>(nullptr), [&](const char* name, auto Struct::*member, const char*, const char*) { columns.add(name, member, offset); });
  const py::dtype type(columns.names, columns.types, columns.offsets, py::ssize_t(sizeof(Element)));
  return read_only(type, {py::ssize_t(rows.size())}, {py::ssize_t(sizeof(Element))}, rows.data(), owner);
}
template <class Struct>
py::array table(const std::vector<Struct>& rows, py::handle owner) {
  return table<Struct>(rows, owner, 0, [](Columns&) {});
}

}  // namespace jamscope::python
