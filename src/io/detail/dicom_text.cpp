// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of DICOM files in UTF-8. The converter of DCMTK does not know all sets that switch by escape sequences
// everywhere, and changes nothing in a file with one that it does not know. Here the C library's iconv converts each
// run of bytes between escape sequences.
#include "detail/dicom_text.hpp"

#include "detail/text.hpp"
#include "stylet/core/printable.hpp"

#include <iconv.h>

#include <algorithm>
#include <array>

namespace stylet::detail {

namespace {

/// A character set: its number in ISO-IR as DICOM writes it, the escape sequences (after ESC) that select it, and its
/// name for iconv.
struct CharacterSet {
  std::string_view number, low_escape, high_escape, name;
};

/// For the Japanese sets of two bytes, which lie in 7 bits, iconv needs the escape sequence itself.
constexpr std::string_view kTwoBytes = "ISO-2022-JP-2";
constexpr std::array kSets{CharacterSet{"6", "(B", "", "ASCII"},
                           CharacterSet{"13", "(J", ")I", "SHIFT_JIS"},
                           CharacterSet{"87", "$B", "", kTwoBytes},
                           CharacterSet{"87", "$@", "", kTwoBytes},
                           CharacterSet{"159", "$(D", "", kTwoBytes},
                           CharacterSet{"149", "", "$)C", "EUC-KR"},
                           CharacterSet{"58", "", "$)A", "GB2312"},
                           CharacterSet{"100", "", "-A", "ISO-8859-1"},
                           CharacterSet{"101", "", "-B", "ISO-8859-2"},
                           CharacterSet{"109", "", "-C", "ISO-8859-3"},
                           CharacterSet{"110", "", "-D", "ISO-8859-4"},
                           CharacterSet{"144", "", "-L", "ISO-8859-5"},
                           CharacterSet{"127", "", "-G", "ISO-8859-6"},
                           CharacterSet{"126", "", "-F", "ISO-8859-7"},
                           CharacterSet{"138", "", "-H", "ISO-8859-8"},
                           CharacterSet{"148", "", "-M", "ISO-8859-9"},
                           CharacterSet{"203", "", "-b", "ISO-8859-15"},
                           CharacterSet{"166", "", "-T", "TIS-620"},
                           CharacterSet{"192", "", "", "UTF-8"},
                           CharacterSet{"GB18030", "", "", "GB18030"},
                           CharacterSet{"GBK", "", "", "GBK"}};

/// Bytes in another character set as UTF-8; bytes that this set does not have become U+FFFD.
std::string converted(std::string bytes, std::string_view from) {
  const iconv_t converter = iconv_open("UTF-8", std::string(from).c_str());
  const bool known = converter != reinterpret_cast<iconv_t>(-1);  // NOLINT: the error value of POSIX
  std::string out;
  char* next = bytes.data();
  std::size_t left = bytes.size();
  while (left > 0) {
    std::array<char, 256> piece{};
    char* end = piece.data();
    std::size_t room = piece.size();
    const std::size_t before = left;
    if (known) iconv(converter, &next, &left, &end, &room);
    out.append(piece.data(), end);
    if (left == before && end == piece.data()) {
      out += "\xEF\xBF\xBD";
      ++next;
      --left;
    }
  }
  if (known) iconv_close(converter);
  return out;
}

/// The set that a value of SpecificCharacterSet names: "ISO_IR 100", "ISO 2022 IR 100", "GB18030", and misspellings
/// that are common ("ISO-IR 100", "ISO IR 100").
const CharacterSet* set_named(std::string_view value) {
  const std::string text = trimmed(value);
  const auto digits = text.find_last_not_of("0123456789");
  const bool numbered = text.starts_with("ISO") && digits != std::string::npos;
  const std::string_view number = numbered ? std::string_view(text).substr(digits + 1) : std::string_view(text);
  const auto* const found =
      std::find_if(kSets.begin(), kSets.end(), [&](const CharacterSet& s) { return s.number == number; });
  return found == kSets.end() ? nullptr : found;
}

/// Follows the escape sequences of a text.
class Decoder {
 public:
  /// @param first set of the bytes above 0x7F before the first escape; may be null
  explicit Decoder(const CharacterSet* first) {
    // ASCII has no such bytes, and the sets of two bytes lie below.
    if (first != nullptr && first->name != kTwoBytes && first->name != kSets[0].name) high_ = first;
  }

  std::string run(std::string_view text) {
    while (!text.empty()) {
      if (text.front() == '\x1B') {
        text.remove_prefix(1);
        text.remove_prefix(escape(text));
        continue;
      }
      const bool high = is_high(text.front());
      const auto end =
          std::find_if(text.begin(), text.end(), [&](char c) { return c == '\x1B' || is_high(c) != high; });
      const auto length = static_cast<std::size_t>(end - text.begin());
      take(text.substr(0, length), high);
      text.remove_prefix(length);
    }
    return out_;
  }

 private:
  static bool is_high(char c) { return static_cast<unsigned char>(c) >= 0x80; }

  /// Selects the set of an escape sequence. Returns the length of the sequence after ESC; 0 if it is not known.
  std::size_t escape(std::string_view text) {
    for (const CharacterSet& set : kSets) {
      if (!set.low_escape.empty() && text.starts_with(set.low_escape)) {
        low_ = &set;
        low_escape_ = set.low_escape;
        return set.low_escape.size();
      }
      if (!set.high_escape.empty() && text.starts_with(set.high_escape)) {
        high_ = &set;
        return set.high_escape.size();
      }
    }
    // Another sequence of ISO 2022: intermediate bytes, then a final one.
    const auto final = std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '/'; });
    out_ += "\xEF\xBF\xBD";
    return final == text.end() ? text.size() : static_cast<std::size_t>(final - text.begin()) + 1;
  }

  void take(std::string_view bytes, bool high) {
    if (!high && low_->name == kTwoBytes) {
      out_ += converted("\x1B" + std::string(low_escape_) + std::string(bytes) + "\x1B(B", kTwoBytes);
    } else if (!high) {
      out_ += bytes;  // ASCII, and Japanese Roman letters, which differ from it in two signs only
    } else {
      // Of bytes for which the file names no set, printable() replaces those that are not UTF-8.
      out_ += high_ == nullptr ? std::string(bytes) : converted(std::string(bytes), high_->name);
    }
  }

  const CharacterSet* low_ = &kSets[0];
  const CharacterSet* high_ = nullptr;
  std::string_view low_escape_;
  std::string out_;
};

}  // namespace

std::string dicom_utf8(std::string_view text, std::string_view character_sets) {
  const auto values = split(character_sets, '\\');
  const CharacterSet* first = set_named(values.front());
  // These sets use bytes below 0x80 within a character and know no escape sequences.
  const bool whole = first != nullptr && (first->name == "GB18030" || first->name == "GBK" || first->name == "UTF-8");
  return printable(whole ? converted(std::string(text), first->name) : Decoder(first).run(text));
}

}  // namespace stylet::detail
