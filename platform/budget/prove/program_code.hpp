// Machine code of a program file: function symbols, bytes at an address, and the slots that the
// loader fills. x86-64 and arm64, 64-bit ELF.
//
// Source: System V ABI, gABI 4.1 chapters 4 and 5; x86-64 psABI table 4.9; AArch64 ELF,
// section 5.7.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint::prove {

enum class Machine : std::uint8_t { x86_64, arm64 };
[[nodiscard]] std::string name_of(Machine machine);

struct FunctionSymbol {
  std::uint64_t address = 0;
  std::uint64_t size = 0;
  std::vector<std::string> linker_names;  // aliases, in the order of the symbol table
  std::string name;                       // demangled
};

// What the loader writes into a slot: an imported function's name, or an address of this program.
struct LoadedSlot {
  std::string name;
  std::uint64_t address = 0;
};

class ProgramCode {
 public:
  // Throws InputError if the file is no program of a supported machine, or has no symbols.
  explicit ProgramCode(const std::string& path);

  [[nodiscard]] Machine machine() const { return machine_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // Bytes from the address to the end of its section; empty outside of every section.
  [[nodiscard]] std::span<const std::uint8_t> bytes_at(std::uint64_t address) const;
  [[nodiscard]] bool is_code(std::uint64_t address) const;
  [[nodiscard]] bool is_constant(std::uint64_t address) const;  // read only at run time
  // The function that starts at the address, or that contains it; null if there is none.
  [[nodiscard]] const FunctionSymbol* function_at(std::uint64_t address) const;
  [[nodiscard]] const FunctionSymbol* function_around(std::uint64_t address) const;
  // All functions whose demangled name starts with the text.
  [[nodiscard]] std::vector<const FunctionSymbol*> functions_named(const std::string& start) const;
  [[nodiscard]] const LoadedSlot* slot_at(std::uint64_t address) const;
  // "glint::find_blobs(..)+0x12"
  [[nodiscard]] std::string text_of(std::uint64_t address) const;

 private:
  struct Section {
    std::uint64_t address;
    std::vector<std::uint8_t> bytes;
    bool executable, writable;
  };
  [[nodiscard]] const Section* section_of(std::uint64_t address) const;
  friend class ElfReader;

  std::string path_;
  Machine machine_ = Machine::x86_64;
  std::vector<Section> sections_;
  std::map<std::uint64_t, FunctionSymbol> functions_;
  std::map<std::uint64_t, LoadedSlot> slots_;
};

// Name without its parameters and without "[clone ..]": "glint::find_blobs".
[[nodiscard]] std::string short_name(const std::string& demangled);

}  // namespace glint::prove
