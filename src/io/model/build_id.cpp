// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/build_id.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace stylet::detail {
namespace {

/// The bytes of a segment of a loaded object.
std::string_view bytes_of(const dl_phdr_info& object, const ElfW(Phdr) & part) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
  return {reinterpret_cast<const char*>(object.dlpi_addr + part.p_vaddr), part.p_memsz};
}

/// Whether an address lies in a loaded object.
bool holds(const dl_phdr_info& object, const void* address) {
  for (int k = 0; k < object.dlpi_phnum; ++k) {
    if (object.dlpi_phdr[k].p_type != PT_LOAD) continue;
    const std::string_view bytes = bytes_of(object, object.dlpi_phdr[k]);
    if (address >= bytes.data() && address < bytes.data() + bytes.size()) return true;
  }
  return false;
}

/// The build id in a series of ELF notes; empty if there is none.
std::string id_among(std::string_view notes, std::size_t alignment) {
  const auto padded = [&](std::size_t size) { return (size + alignment - 1) / alignment * alignment; };
  constexpr std::string_view owner("GNU\0", 4);
  while (notes.size() >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data(), sizeof note);
    const std::size_t name = sizeof note;
    const std::size_t content = name + padded(note.n_namesz);
    const std::size_t end = content + padded(note.n_descsz);
    if (end > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && notes.substr(name, note.n_namesz) == owner) {
      std::string text;
      for (const char byte : notes.substr(content, note.n_descsz))
        text += fmt::format("{:02x}", static_cast<std::uint8_t>(byte));
      return text;
    }
    notes.remove_prefix(end);
  }
  return {};
}

int visit(dl_phdr_info* object, std::size_t, void* text) {
  static const char mine = 0;
  if (!holds(*object, &mine)) return 0;
  auto& id = *static_cast<std::string*>(text);
  for (int k = 0; k < object->dlpi_phnum && id.empty(); ++k) {
    const ElfW(Phdr)& part = object->dlpi_phdr[k];
    if (part.p_type == PT_NOTE) id = id_among(bytes_of(*object, part), part.p_align == 8 ? 8 : 4);
  }
  return 1;  // stops the iteration
}

}  // namespace

std::string build_id() {
  std::string id;
  dl_iterate_phdr(visit, &id);
  return id;
}

}  // namespace stylet::detail
