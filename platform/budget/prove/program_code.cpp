#include "platform/budget/prove/program_code.hpp"

#include <cxxabi.h>
#include <fcntl.h>
#include <gelf.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "platform/input_error.hpp"

namespace glint::prove {
namespace {

std::string demangled(const char* name) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> text(
      abi::__cxa_demangle(name, nullptr, nullptr, &status), &std::free);
  return status == 0 ? text.get() : name;
}

// Local parts that a compiler has moved away from its function; not functions by themselves.
bool is_moved_part(const std::string& linker_name) {
  return linker_name.find(".cold") != std::string::npos;
}

}  // namespace

std::string name_of(Machine machine) { return machine == Machine::x86_64 ? "x86-64" : "arm64"; }

class ElfReader {
 public:
  explicit ElfReader(ProgramCode& code) : code_(code) {
    elf_version(EV_CURRENT);
    file_ = open(code.path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) throw InputError(code.path_ + ": cannot be read; expected a program");
    elf_ = elf_begin(file_, ELF_C_READ, nullptr);
  }
  ~ElfReader() {
    elf_end(elf_);
    close(file_);
  }
  ElfReader(const ElfReader&) = delete;
  ElfReader& operator=(const ElfReader&) = delete;

  void read() {
    GElf_Ehdr header;
    if (elf_ == nullptr || elf_kind(elf_) != ELF_K_ELF || gelf_getehdr(elf_, &header) == nullptr ||
        (header.e_machine != EM_X86_64 && header.e_machine != EM_AARCH64)) {
      throw InputError(code_.path_ + ": is no program; expected x86-64 or arm64 ELF");
    }
    code_.machine_ = header.e_machine == EM_X86_64 ? Machine::x86_64 : Machine::arm64;
    for_each_section([&](const GElf_Shdr& section, Elf_Scn* at) { read_bytes(section, at); });
    for_each_section([&](const GElf_Shdr& section, Elf_Scn* at) {
      if (section.sh_type == SHT_SYMTAB || section.sh_type == SHT_DYNSYM) read_symbols(section, at);
    });
    for_each_section([&](const GElf_Shdr& section, Elf_Scn* at) {
      if (section.sh_type == SHT_RELA) read_slots(section, at);
    });
    if (code_.functions_.empty()) {
      throw InputError(code_.path_ + ": has no function symbols; expected an unstripped program");
    }
  }

 private:
  template <class Body>
  void for_each_section(const Body& body) {
    for (Elf_Scn* at = nullptr; (at = elf_nextscn(elf_, at)) != nullptr;) {
      GElf_Shdr section;
      if (gelf_getshdr(at, &section) != nullptr) body(section, at);
    }
  }

  void read_bytes(const GElf_Shdr& section, Elf_Scn* at) {
    if ((section.sh_flags & SHF_ALLOC) == 0 || section.sh_type == SHT_NOBITS) return;
    const Elf_Data* data = elf_rawdata(at, nullptr);
    if (data == nullptr || data->d_buf == nullptr) return;
    const auto* bytes = static_cast<const std::uint8_t*>(data->d_buf);
    code_.sections_.push_back({section.sh_addr,
                               {bytes, bytes + data->d_size},
                               (section.sh_flags & SHF_EXECINSTR) != 0,
                               (section.sh_flags & SHF_WRITE) != 0});
  }

  void read_symbols(const GElf_Shdr& section, Elf_Scn* at) {
    Elf_Data* data = elf_getdata(at, nullptr);
    const auto count = section.sh_entsize == 0 ? 0 : section.sh_size / section.sh_entsize;
    for (std::uint64_t i = 0; i < count; ++i) {
      GElf_Sym symbol;
      if (gelf_getsym(data, static_cast<int>(i), &symbol) == nullptr) continue;
      const int type = GELF_ST_TYPE(symbol.st_info);
      const char* name = elf_strptr(elf_, section.sh_link, symbol.st_name);
      if ((type != STT_FUNC && type != STT_GNU_IFUNC) || symbol.st_shndx == SHN_UNDEF ||
          name == nullptr || is_moved_part(name)) {
        continue;
      }
      FunctionSymbol& function = code_.functions_[symbol.st_value];
      function.address = symbol.st_value;
      function.size = std::max<std::uint64_t>(function.size, symbol.st_size);
      if (function.linker_names.empty()) function.name = demangled(name);
      function.linker_names.emplace_back(name);
    }
  }

  void read_slots(const GElf_Shdr& section, Elf_Scn* at) {
    GElf_Shdr symbols;
    Elf_Scn* symbols_at = elf_getscn(elf_, section.sh_link);
    const bool has_symbols = symbols_at != nullptr && section.sh_link != 0 &&
                             gelf_getshdr(symbols_at, &symbols) != nullptr;
    Elf_Data* data = elf_getdata(at, nullptr);
    const auto count = section.sh_entsize == 0 ? 0 : section.sh_size / section.sh_entsize;
    for (std::uint64_t i = 0; i < count; ++i) {
      GElf_Rela entry;
      if (gelf_getrela(data, static_cast<int>(i), &entry) == nullptr) continue;
      const auto symbol_index = static_cast<int>(GELF_R_SYM(entry.r_info));
      LoadedSlot slot;
      GElf_Sym symbol;
      if (symbol_index != 0 && has_symbols &&
          gelf_getsym(elf_getdata(symbols_at, nullptr), symbol_index, &symbol) != nullptr) {
        slot.name = elf_strptr(elf_, symbols.sh_link, symbol.st_name);
      } else if (symbol_index == 0) {
        slot.address = static_cast<std::uint64_t>(entry.r_addend);
      }
      code_.slots_[entry.r_offset] = slot;
    }
  }

  ProgramCode& code_;
  int file_ = -1;
  Elf* elf_ = nullptr;
};

ProgramCode::ProgramCode(const std::string& path) : path_(path) { ElfReader(*this).read(); }

const ProgramCode::Section* ProgramCode::section_of(std::uint64_t address) const {
  const auto inside = [&](const Section& section) {
    return address >= section.address && address - section.address < section.bytes.size();
  };
  const auto found = std::find_if(sections_.begin(), sections_.end(), inside);
  return found == sections_.end() ? nullptr : &*found;
}

std::span<const std::uint8_t> ProgramCode::bytes_at(std::uint64_t address) const {
  const Section* section = section_of(address);
  if (section == nullptr) return {};
  return std::span(section->bytes).subspan(address - section->address);
}

bool ProgramCode::is_code(std::uint64_t address) const {
  const Section* section = section_of(address);
  return section != nullptr && section->executable;
}

bool ProgramCode::is_constant(std::uint64_t address) const {
  const Section* section = section_of(address);
  return section != nullptr && !section->writable;
}

const FunctionSymbol* ProgramCode::function_at(std::uint64_t address) const {
  const auto found = functions_.find(address);
  return found == functions_.end() ? nullptr : &found->second;
}

const FunctionSymbol* ProgramCode::function_around(std::uint64_t address) const {
  auto after = functions_.upper_bound(address);
  if (after == functions_.begin()) return nullptr;
  const FunctionSymbol& function = std::prev(after)->second;
  return address == function.address || address - function.address < function.size ? &function
                                                                                   : nullptr;
}

std::vector<const FunctionSymbol*> ProgramCode::functions_named(const std::string& start) const {
  std::vector<const FunctionSymbol*> found;
  for (const auto& [address, function] : functions_) {
    if (function.name.starts_with(start)) found.push_back(&function);
  }
  return found;
}

const LoadedSlot* ProgramCode::slot_at(std::uint64_t address) const {
  const auto found = slots_.find(address);
  return found == slots_.end() ? nullptr : &found->second;
}

std::string ProgramCode::text_of(std::uint64_t address) const {
  char text[32];
  const FunctionSymbol* function = function_around(address);
  if (function == nullptr) {
    std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(address));
    return text;
  }
  std::snprintf(text, sizeof text, "+0x%llx",
                static_cast<unsigned long long>(address - function->address));
  return short_name(function->name) + text;
}

std::string short_name(const std::string& demangled_name) {
  std::string name;
  int depth = 0;
  constexpr std::string_view k_unnamed = "(anonymous namespace)";
  for (std::size_t i = 0; i < demangled_name.size(); ++i) {
    const std::string_view rest = std::string_view(demangled_name).substr(i);
    if (depth == 0 && rest.starts_with(k_unnamed)) {
      name += k_unnamed;
      i += k_unnamed.size() - 1;
    } else if (depth == 0 && rest.starts_with("operator()")) {
      name += "operator()";
      i += 9;
    } else if (depth == 0 && (rest.starts_with("(") || rest.starts_with(" [clone"))) {
      break;
    } else {
      if (rest.front() == '<') ++depth;
      if (rest.front() == '>') --depth;
      name += rest.front();
    }
  }
  return name;
}

}  // namespace glint::prove
