#include <coplane_core/Text.hpp>

#include <cstdint>

namespace coplane
{
namespace
{
/// Bytes of the character of UTF-8 that begins here; 0: there is none.
std::size_t lengthOfCharacter(const std::string& bytes, std::size_t at)
{
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned first = byte(at);
  if (first < 0x80)
    return 1;
  const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || at + length > bytes.size())
    return 0;
  std::uint32_t code = first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i)
  {
    if ((byte(at + i) & 0xc0u) != 0x80u)
      return 0;
    code = code << 6 | (byte(at + i) & 0x3fu);
  }
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  return surrogate || overlong || code > 0x10ffff ? 0 : length;
}
} // namespace

std::string csvField(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::string field = "\"";
  for (const char c : text)
    field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

std::string shellWord(const std::string& text)
{
  constexpr const char* plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!text.empty() && text[0] != '-' && text.find_first_not_of(plain) == std::string::npos)
    return text;
  std::string word = text[0] == '-' ? "'./" : "'";
  for (const char c : text)
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string xmlText(const std::string& text)
{
  const std::string utf8 = asUtf8(text);
  std::string xml;
  for (const char c : utf8)
    switch (c)
    {
    case '&':
      xml += "&amp;";
      break;
    case '<':
      xml += "&lt;";
      break;
    case '>':
      xml += "&gt;";
      break;
    case '"':
      xml += "&quot;";
      break;
    case '\t':
      xml += "&#9;";
      break;
    case '\n':
      xml += "&#10;";
      break;
    case '\r':
      xml += "&#13;";
      break;
    default:
      if (static_cast<unsigned char>(c) < 0x20)
        xml += "\xef\xbf\xbd";
      else
        xml += c;
    }
  return xml;
}

bool isUtf8(const std::string& bytes)
{
  for (std::size_t at = 0; at < bytes.size();)
  {
    const std::size_t length = lengthOfCharacter(bytes, at);
    if (length == 0)
      return false;
    at += length;
  }
  return true;
}

std::string latin1AsUtf8(const std::string& bytes)
{
  std::string text;
  for (const char c : bytes)
  {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80)
      text += c;
    else
    {
      text += static_cast<char>(0xc0 | byte >> 6);
      text += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return text;
}

std::string utf8AsLatin1(const std::string& text)
{
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const auto first = static_cast<unsigned char>(text[i]);
    if ((first & 0xfcu) == 0xc0u && i + 1 < text.size())
      bytes +=
          static_cast<char>((first & 3u) << 6 | (static_cast<unsigned char>(text[++i]) & 0x3fu));
    else
      bytes += text[i];
  }
  return bytes;
}

std::string asUtf8(const std::string& bytes)
{
  return isUtf8(bytes) ? bytes : latin1AsUtf8(bytes);
}
} // namespace coplane
