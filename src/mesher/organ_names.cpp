// SPDX-License-Identifier: GPL-3.0-or-later
#include "organ_names.hpp"

#include "stylet/geom/structure_names.hpp"
#include "words.hpp"

#include <array>
#include <cctype>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace stylet::meshing {

namespace {

struct Names {
  std::string_view region, names;  ///< names separated by '|'
};

// Whole names: "optBladder", "Prostate+5mm" or "Rectum_in_PTV" are planning helpers, not anatomy. The names are those
// of AAPM TG-263 (Mayo et al. 2018), of common planning systems, and German, French, Spanish, Italian, Chinese,
// Japanese and Russian ones. Names that mean two organs are left out: "SB" (Samenblasen, small bowel), "ПЖ" (prostate,
// pancreas).
constexpr std::array kOrgans{
    Names{"prostate",
          "prostate|pros|prost|prostata|próstata|prostategland|glandprostate|gland|wholegland|"
          "prostatewhole|wholeprostate|wg|prostatecapsule|prostatemr|prostatemri|prostatect|prostateus|"
          "prostatetrus|Vorsteherdrüse|Prostatadrüse|Prostata gesamt|ganze Prostata|"
          "glandula prostatica|glandula prostatae|prostat|glande prostatique|glande prostate|"
          "prostate entière|prostate totale|glándula prostática|próstata completa|próstata entera|"
          "próstata total|ghiandola prostatica|prostata MR|prostata MRT|prostata CT|prostata US|"
          "prostata TRUS|prostate IRM|próstata RM|próstata TC|próstata TAC|前列腺|前列腺体|前列腺腺体|摄护腺|攝護腺|"
          "前列腺MRI|前列腺CT|前立腺|前立腺全体|前立腺MRI|前立腺CT|простата|простаты|простату|предстательная железа|"
          "предстательной железы|предст железа|предст. ж-за|предстат железа|железа предстательная|"
          "вся простата|простата МРТ|простата КТ"},
    Names{"transition_zone",
          "centralgland|cg|zentrale Drüse|glande centrale|glándula central|中央腺体|中央腺體|центральная железа"},
    Names{"urethra",
          "urethra|urethraprostatic|prostaticurethra|urethraprostate|distalprostaticurethra|dpu|uretra|"
          "urethre|urètre|harnröhre|harnroehre|Harnröhre|prostatische Harnröhre|prostatische Urethra|"
          "Urethra prostatica|pars prostatica urethrae|urètre prostatique|urèthre|urethre prostatique|"
          "uretra prostática|uretra prostatica|尿道|前列腺尿道|尿道前列腺部|前立腺部尿道|前立腺尿道|уретра|уретры|"
          "простатическая уретра|уретра простатическая|простатический отдел уретры|"
          "мочеиспускательный канал|мочеиспускательного канала"},
    Names{"bladder",
          "bladder|urinarybladder|bladderwall|wallbladder|blase|harnblase|vessie|vescica|vejiga|blad|"
          "Blasenwand|Harnblasenwand|vesica urinaria|vessie urinaire|paroi vésicale|paroi de la vessie|"
          "paroi vessie|vejiga urinaria|vejiga de la orina|pared vesical|pared de la vejiga|"
          "pared vejiga|vescica urinaria|膀胱|膀胱壁|мочевой пузырь|мочевого пузыря|мочевой пуз|моч пузырь|"
          "моч. пузырь|м. пузырь|стенка мочевого пузыря|МП"},
    Names{"rectum",
          "rectum|rectalwall|rectumwall|wallrectum|rektum|recto|retto|enddarm|anorectum|rect|Mastdarm|"
          "Rektumwand|Rektalwand|Darm rektal|Anorektum|paroi rectale|paroi du rectum|paroi rectum|"
          "ampoule rectale|pared rectal|pared del recto|pared recto|anorrecto|ampolla rectal|rettale|"
          "parete rettale|直肠|直腸|直肠壁|直腸壁|прямая кишка|прямой кишки|прямую кишку|прям кишка|прям. кишка|"
          "стенка прямой кишки|ректум"},
    Names{"pubic_arch",
          "pubicarch|pubis|pubicbone|pubicbones|bonepubic|bonepelvicpubis|symphysis|pubicsymphysis|"
          "symphysispubis|symphysispubica|pubicsymphys|arch|pubicsymphysisbone|symphyse|schambein|"
          "Schambeinbogen|Schambogen|Schambeine|Schambeinfuge|Schambeinsymphyse|Symphysis ossium pubis|"
          "Os pubis|Ossa pubis|Symphyse pubienne|symphyse du pubis|arc pubien|arcade pubienne|"
          "os pubien|os pubiens|branches pubiennes|sínfisis|sínfisis púbica|sínfisis pubiana|"
          "sínfisis del pubis|arco púbico|arco pubiano|arco del pubis|hueso púbico|huesos púbicos|"
          "sinfisi|sinfisi pubica|arco pubico|osso "
          "pubico|耻骨|恥骨|耻骨弓|恥骨弓|耻骨联合|恥骨联合|恥骨聯合|恥骨結合|耻骨结合|"
          "симфиз|лобковый симфиз|лонный симфиз|лонное сочленение|лобковое сочленение|лобковая дуга|"
          "лонная дуга|лобковая кость|лонная кость|лобковые кости|лонные кости"},
    Names{"band", "band|stiffband|puboprostaticligament|puboprostaticligaments"},
    Names{"body",
          "body|external|skin|patient|outline|patientoutline|outercontour|bodycontour|externalcontour|"
          "haut|körper|koerper|aussenkontur|außenkontur|corps|corpo|cuerpo|piel|contourexterne|"
          "perinealskin|surroundings|Körperkontur|Körperumriss|Körperoberfläche|Außenkontur|"
          "Patientenkontur|Hautoberfläche|peau|contour du corps|contour corps|contour patient|"
          "contour extérieur|externe|corps entier|externo|contorno externo|contorno corporal|"
          "contorno del cuerpo|contorno del paciente|contorno paciente|superficie corporal|paciente|"
          "pelle|cute|身体|身體|体表|體表|体表轮廓|體表輪廓|外轮廓|外輪廓|体轮廓|身体轮廓|皮肤|皮膚|患者轮廓|体輪郭|"
          "体輪郭線|外輪郭|体表輪郭|ボディ|患者輪郭|"
          "тело|тело пациента|кожа|контур тела|контур пациента|внешний контур|наружный контур"},
    Names{"periprostatic_fat", "periprostaticfat|periprostaticadiposetissue|fatperiprostatic"},
    Names{"levator", "levator|levatorani|levatoranimuscle|musclelevatorani|muscleslevatorani|mlevatorani"},
    Names{"ischiorectal_fat", "ischiorectalfat|ischiorectalfossa|ischioanalfat|ischioanalfossa"},
    Names{"subcutaneous_fat", "subcutaneousfat|subcutaneousadiposetissue|fatsubcutaneous"},
    Names{"rectal_lumen", "rectallumen|rectumlumen|lumenrectum|lumière rectale|lumen rectal|luz rectal|Rektumlumen"},
    Names{"seminal_vesicles",
          "seminalvesicles|seminalvesicle|seminalves|semvesicles|vesiculaeseminales|samenblasen|sv|svs|"
          "semves|Samenblase|Samenbläschen|Bläschendrüse|Bläschendrüsen|vesiculae seminales|"
          "vesicula seminalis|vésicules séminales|vésicule séminale|VS|vésic sém|ves sem|"
          "vesículas seminales|vesícula seminal|VVSS|vescicole seminali|vescichette seminali|"
          "vescicola seminale|精囊|精囊腺|精嚢|精嚢腺|精のう|精のう腺|双侧精囊|両側精嚢|семенные пузырьки|семенных "
          "пузырьков|"
          "семенной пузырек|семенной пузырёк|сем пузырьки|сем. пузырьки"}};

// Without the words for side, gland and "of", which zone_named() removes.
constexpr std::array kZones{
    Names{"peripheral_zone",
          "peripheral|peripheral zone|periperal|periperal zone|PZ|periphere|periphere Zone|"
          "Peripherzone|périphérique|zone périphérique|ZP|periférica|zona periférica|zona periferica|"
          "periferica|外周带|外周帶|外周区|外周區|周围带|周缘带|辺縁域|辺縁領域|辺縁帯|末梢域|периферическая|"
          "периферическая зона|"
          "периферической зоны|периф зона"},
    Names{"transition_zone",
          "transition|transitional|transition zone|transitional zone|TZ|Transitionszone|"
          "Transitionalzone|Übergangszone|transitionnelle|zone transitionnelle|zone de transition|"
          "zona de transición|transición|transicional|zona transicional|zona di transizione|ZT|移行带|移行帶|"
          "移行区|移行區|移行域|移行領域|移行帯|переходная|переходная зона|переходной зоны|транзиторная зона|"
          "транзиторная"},
    Names{"central_zone",
          "central|central zone|CZ|zentrale Zone|Zentralzone|centrale|zone centrale|zona central|"
          "zona centrale|ZC|中央带|中央帶|中央区|中央區|中心域|中心領域|中央域|центральная зона|центральной "
          "зоны|центральная"},
    Names{"anterior_stroma",
          "AFS|AFMS|anterior stroma|fibromuscular stroma|anterior fibromuscular stroma|"
          "anterior fibromuscular|anterior fibromuscular zone|anteriores fibromuskuläres Stroma|"
          "vorderes fibromuskuläres Stroma|fibromuskuläres Stroma|stroma fibromusculaire antérieur|"
          "stroma fibromusculaire|SFMA|estroma fibromuscular anterior|estroma fibromuscular|"
          "stroma fibromuscolare "
          "anteriore|前纤维肌肉基质|前纤维肌基质|前纤维肌肉基质带|前纤维肌基质带|前部纤维肌肉基质|前部線維筋性間質|"
          "前部線維筋間質|"
          "前線維筋性間質|передняя фибромускулярная строма|фибромускулярная строма|"
          "передняя фибромышечная строма"}};

// One femoral head; its side is written before, after or between the words.
constexpr std::string_view kFemur =
    "femur|femoral head|femoral heads|fem head|femur head|head femur|fem head neck|"
    "femur head neck|femoral neck|FH|fem head and neck|hip|Femurkopf|Hüftkopf|Hueftkopf|caput|"
    "Caput femoris|Oberschenkelkopf|Femurköpfchen|tête fémorale|tête du fémur|tête de fémur|"
    "tête fémur|fémur|tête fém|cabeza femoral|cabeza de fémur|cabeza del fémur|cabeza fémur|"
    "cab femoral|testa femorale|testa del femore|femore|股骨头|股骨頭|股骨|大腿骨頭|大腿骨|大腿骨骨頭|головка бедра|"
    "головка бедренной кости|головки бедра|головки бедренной кости|головка бедр кости|"
    "головка тазобедренного сустава|бедренная кость|бедро|гол бедра|шейка бедра";

constexpr std::string_view kLeft =
    "left|l|lt|li|links|linke|linker|linkes|gauche|g|izquierda|izquierdo|izq|izqda|sinistra|sinistro|sin|sx|"
    "левая|левой|левый|левого|лев|л|слева|左|左侧|左側";
constexpr std::string_view kRight =
    "right|r|rt|re|rechts|rechte|rechter|rechtes|droite|droit|d|derecha|derecho|der|dcha|dch|destra|destro|dx|"
    "правая|правой|правый|правого|прав|пр|справа|右|右侧|右側";

/// Hands over the parts of a list between '|'.
void read_list(std::string_view list, const std::function<void(std::string_view)>& take) {
  while (!list.empty()) {
    const auto end = list.find('|');
    take(list.substr(0, end));
    list = end == std::string_view::npos ? std::string_view{} : list.substr(end + 1);
  }
}

using Table = std::map<std::string, std::string_view, std::less<>>;

template <std::size_t N>
Table table_of(const std::array<Names, N>& rows) {
  Table table;
  for (const Names& row : rows) {
    table.emplace(plain(row.region), row.region);
    read_list(row.names, [&](std::string_view name) { table.emplace(plain(name), row.region); });
  }
  return table;
}

std::set<std::string, std::less<>> set_of(std::string_view list) {
  std::set<std::string, std::less<>> all;
  read_list(list, [&](std::string_view name) { all.insert(plain(name)); });
  return all;
}

std::string_view found_in(const Table& table, std::string_view name) {
  const auto found = table.find(name);
  return found == table.end() ? std::string_view{} : found->second;
}

/// Removes a word at either end of a name that is written without blanks, as in Chinese and Japanese.
void strip(std::string& name, std::string_view word) {
  if (name.size() > word.size() && name.starts_with(word)) name.erase(0, word.size());
  if (name.size() > word.size() && name.ends_with(word)) name.erase(name.size() - word.size());
}

}  // namespace

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : folded(name)) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || u >= 0x80) out += static_cast<char>(std::tolower(u));
  }
  return out;
}

std::string_view organ_named(std::string_view plain_name) {
  static const Table table = table_of(kOrgans);
  return found_in(table, plain_name);
}

std::string_view side_of(std::string_view name) {
  static const auto left = set_of(kLeft), right = set_of(kRight);
  for (const std::string& word : words_of(name)) {
    if (left.contains(word) || word.starts_with("左") || word.ends_with("左")) return "left";
    if (right.contains(word) || word.starts_with("右") || word.ends_with("右")) return "right";
  }
  return "";
}

std::string femur_named(std::string_view name) {
  static const auto bones = set_of(kFemur), left = set_of(kLeft), right = set_of(kRight);
  const std::string whole = plain(name);
  std::string rest;
  std::string_view side;
  for (const std::string& word : words_of(name)) {
    const std::string_view here = left.contains(word) ? "left" : right.contains(word) ? "right" : "";
    if (here.empty()) rest += word;
    if (!here.empty() && !side.empty() && here != side) return {};
    if (!here.empty()) side = here;
  }
  if (!side.empty() && bones.contains(rest)) return "femur_" + std::string(side);
  for (const auto& [sides, canonical] : {std::pair{&left, "femur_left"}, std::pair{&right, "femur_right"}}) {
    for (const std::string& word : *sides) {
      for (const bool before : {true, false}) {
        if (before ? !whole.starts_with(word) : !whole.ends_with(word)) continue;
        const std::string bone = before ? whole.substr(word.size()) : whole.substr(0, whole.size() - word.size());
        // A single foreign letter means a side only where it is a word ("tête fémorale G").
        if (bones.contains(bone) && (word.size() > 1 || word == "l" || word == "r")) return canonical;
      }
    }
  }
  return {};
}

std::string_view zone_named(std::string_view name) {
  static const Table table = table_of(kZones);
  static const auto sides = [] {
    auto all = set_of(kLeft);
    all.merge(set_of(kRight));
    return all;
  }();
  static const auto beside = set_of(
      "of|the|prostate|prostatic|structure|lobe|der|die|Prostata|de|la|le|du|des|del|di|della|prostatique|prostática|"
      "простаты|предстательной|железы");
  std::string rest, before;
  for (const std::string& word : words_of(name)) {
    // "gland" alone is not a filler word, because the central gland is the transition zone.
    const bool filler = beside.contains(word) || sides.contains(word) || (word == "gland" && before == "prostate");
    if (!filler) rest += word;
    before = word;
  }
  for (const std::string_view word :
       {"左侧", "左側", "右侧", "右側", "左", "右", "前列腺", "前立腺", "prostate", "prostata"})
    strip(rest, word);
  if (const auto found = found_in(table, rest); !found.empty()) return found;
  // "central of prostate" without its fillers is a zone as well as "zone of transition" with them.
  return found_in(table, plain(name));
}

}  // namespace stylet::meshing
