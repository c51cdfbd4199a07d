#include "platform/sinks/dds/security_keys.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/sinks/dds/security_files.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

template <auto Free>
struct FreeBy {
  template <class Object>
  void operator()(Object* object) const {
    Free(object);
  }
};
using Key = std::unique_ptr<EVP_PKEY, FreeBy<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, FreeBy<X509_free>>;
using Memory = std::unique_ptr<BIO, FreeBy<BIO_free>>;

constexpr const char* k_curve = "prime256v1";  // of the plug-ins' two algorithms the shorter key
constexpr const char* k_authority = "Glint keys";                           // common name
constexpr std::int64_t k_authority_s = std::int64_t{20} * 365 * 24 * 3600;  // its validity
constexpr int k_serial_bytes = 16;

template <class Result>
Result checked(Result result, const char* what) {
  if (!result) throw InputError(std::string("dds keys: ") + what + ": OpenSSL refused it");
  return result;
}

[[noreturn]] void fail(const std::string& path, const std::string& reason,
                       const std::string& expected) {
  throw InputError("dds keys: " + path + ": " + reason + "; expected " + expected);
}

Memory new_memory() { return Memory(checked(BIO_new(BIO_s_mem()), "memory")); }

Memory memory_of(const std::string& text) {
  return Memory(checked(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), "memory"));
}

std::string text_in(const Memory& memory) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder.string(), error.message(), "a folder that can be written");
}

void write(const std::filesystem::path& path, const std::string& text) {
  const std::string error = write_file_atomically(path.string(), text);
  if (!error.empty()) fail(path.string(), error, "a file that can be written");
}

// Readable by its owner only, from its creation on.
void write_private(const std::filesystem::path& path, const std::string& text) {
  constexpr mode_t only_owner = 0600;
  const int file =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, only_owner);
  const bool written = file >= 0 && write_all(file, text);
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (written) return;
  if (file >= 0) ::unlink(path.c_str());
  fail(path.string(), std::generic_category().message(reason), "a file that can be written");
}

// The key of a file; a new one if the file does not exist.
Key key_at(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    Key key(checked(EVP_EC_gen(k_curve), "a key"));
    const Memory memory = new_memory();
    checked(PEM_write_bio_PKCS8PrivateKey(memory.get(), key.get(), nullptr, nullptr, 0, nullptr,
                                          nullptr),
            "a key");
    write_private(path, text_in(memory));
    return key;
  }
  const Memory file(BIO_new_file(path.c_str(), "r"));
  Key key(file ? PEM_read_bio_PrivateKey(file.get(), nullptr, nullptr, nullptr) : nullptr);
  if (!key) fail(path.string(), "no private key can be read", "a file of `glint dds keys`");
  return key;
}

std::string pem_of(const Certificate& certificate) {
  const Memory memory = new_memory();
  checked(PEM_write_bio_X509(memory.get(), certificate.get()), "a certificate");
  return text_in(memory);
}

struct Authority {
  Key key;
  Certificate certificate;
};

// `issuer`: null for the authority itself.
Certificate certificate_of(const std::string& name, EVP_PKEY* key, const Authority* issuer,
                           const Validity& validity) {
  Certificate made(checked(X509_new(), "a certificate"));
  X509* const one = made.get();
  unsigned char serial[k_serial_bytes];
  checked(RAND_bytes(serial, sizeof serial) == 1, "a serial number");
  serial[0] &= 0x7F;  // positive
  const std::unique_ptr<BIGNUM, FreeBy<BN_free>> number(BN_bin2bn(serial, sizeof serial, nullptr));
  checked(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(one)), "a serial number");
  checked(X509_set_version(one, X509_VERSION_3), "a version");
  checked(ASN1_TIME_set(X509_getm_notBefore(one), validity.from_s), "a time");
  checked(ASN1_TIME_set(X509_getm_notAfter(one), validity.to_s), "a time");
  X509_NAME* const subject = X509_get_subject_name(one);
  checked(
      X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                                 reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0),
      "a name");
  checked(X509_set_issuer_name(
              one, issuer != nullptr ? X509_get_subject_name(issuer->certificate.get()) : subject),
          "an issuer");
  checked(X509_set_pubkey(one, key), "a key");
  const std::unique_ptr<X509_EXTENSION, FreeBy<X509_EXTENSION_free>> constraint(
      checked(X509V3_EXT_conf_nid(nullptr, nullptr, NID_basic_constraints,
                                  issuer != nullptr ? "critical,CA:FALSE" : "critical,CA:TRUE"),
              "a constraint"));
  checked(X509_add_ext(one, constraint.get(), -1), "a constraint");
  checked(X509_sign(one, issuer != nullptr ? issuer->key.get() : key, EVP_sha256()), "a signature");
  return made;
}

Authority authority_in(const std::filesystem::path& folder, const Validity& validity) {
  make_folder(folder / "private");
  make_folder(folder / "public");
  const std::filesystem::path path = folder / "public" / "ca.cert.pem";
  Authority authority{key_at(folder / "private" / "ca.key.pem"), nullptr};
  if (!std::filesystem::exists(path)) {
    authority.certificate = certificate_of(k_authority, authority.key.get(), nullptr,
                                           {validity.from_s, validity.from_s + k_authority_s});
    write(path, pem_of(authority.certificate));
    return authority;
  }
  const Memory file(BIO_new_file(path.c_str(), "r"));
  authority.certificate.reset(file ? PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr)
                                   : nullptr);
  const bool matches =
      authority.certificate != nullptr &&
      X509_check_private_key(authority.certificate.get(), authority.key.get()) == 1;
  if (!matches) fail(path.string(), "no certificate of private/ca.key.pem", "both of one call");
  return authority;
}

// S/MIME with the text in clear, as the plug-ins read it.
std::string signed_by(const Authority& authority, const std::string& text) {
  constexpr int flags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Memory content = memory_of(text), out = new_memory();
  const std::unique_ptr<PKCS7, FreeBy<PKCS7_free>> signature(checked(
      PKCS7_sign(authority.certificate.get(), authority.key.get(), nullptr, content.get(), flags),
      "a signature"));
  checked(SMIME_write_PKCS7(out.get(), signature.get(), content.get(), flags) == 1, "a signature");
  return text_in(out);
}

std::string write_enclave(const KeySettings& settings, const Authority& authority,
                          const std::string& identity, const std::string& permissions) {
  const std::filesystem::path folder =
      std::filesystem::path(settings.folder) / "enclaves" / identity;
  make_folder(folder);
  const Key key = key_at(folder / k_private_key.name);
  const std::string authority_text = pem_of(authority.certificate);
  write(folder / k_identity_ca.name, authority_text);
  write(folder / k_permissions_ca.name, authority_text);
  write(folder / k_certificate.name, pem_of(certificate_of(common_name(identity), key.get(),
                                                           &authority, settings.scope.validity)));
  write(folder / k_governance.name, signed_by(authority, governance_text(settings.scope)));
  write(folder / k_permissions.name, signed_by(authority, permissions));
  return folder.string();
}

void check_names(const KeySettings& settings) {
  std::set<std::string> names{k_run_identity};
  for (const PeerRights& peer : settings.peers) {
    if (peer.name != ros_name(peer.name)) {
      throw InputError("dds keys: peer \"" + peer.name +
                       "\"; expected letters, digits and '_', no digit first");
    }
    if (!names.insert(peer.name).second) {
      throw InputError("dds keys: peer \"" + peer.name + "\" twice, or the run's name \"" +
                       k_run_identity + "\"; expected different names");
    }
  }
}

}  // namespace

std::vector<std::string> write_security_keys(const KeySettings& settings) {
  check_names(settings);
  const Authority authority = authority_in(settings.folder, settings.scope.validity);
  std::vector<std::string> folders{
      write_enclave(settings, authority, k_run_identity, run_permissions_text(settings.scope))};
  for (const PeerRights& peer : settings.peers) {
    folders.push_back(
        write_enclave(settings, authority, peer.name, peer_permissions_text(peer, settings.scope)));
  }
  return folders;
}

}  // namespace glint
