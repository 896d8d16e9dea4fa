#pragma once
// The members of a type in one list, for functions that treat them one after the other.
// Device-safe.

namespace gloam {

namespace members {

template <auto kMember>
struct One {};

/// Stands for a value of any type.
struct Any {
  template <class T>
  operator T() const;
};

/// Number of members of the aggregate T.
template <class T, class... Values>
constexpr int count() {
  if constexpr (requires { T{Values{}..., Any{}}; }) {
    return count<T, Values..., Any>();
  } else {
    return sizeof...(Values);
  }
}

template <class T>
struct CheckedList {
  using List = typename T::Members;
  static_assert(List::kCount == count<T>(), "T::Members must list each member of T");
};

}  // namespace members

/// Pointers to the members of a type. A member that is listed twice does not compile.
template <auto... kMembers>
struct MemberList : members::One<kMembers>... {
  static constexpr int kCount = sizeof...(kMembers);
};

/// T::Members, the list of all members of the aggregate T. A list that lacks one does not compile.
template <class T>
using MembersOf = typename members::CheckedList<T>::List;

}  // namespace gloam
