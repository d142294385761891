// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ElevationLook.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkClientServerInterpreter.h"
#include "vtkClientServerInterpreterInitializer.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVRepresentedArrayListSettings.h"
#include "vtkPVXMLElement.h"
#include "vtkSMChartSeriesSelectionDomain.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyInitializationHelper.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMTransferFunctionProxy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace
{
constexpr char ARRAY[] = "Elevation";

// The words of an attribute, which are separated by sign.
std::vector<std::string> WordsOf(vtkPVXMLElement* xml, const char* name, char sign)
{
  std::istringstream text(xml->GetAttributeOrEmpty(name));
  std::vector<std::string> words;
  for (std::string word; std::getline(text, word, sign);)
  {
    words.push_back(word);
  }
  return words;
}

// Red, green and blue of "#rrggbb".
void AddColour(const std::string& text, std::vector<double>& values)
{
  unsigned int rgb[3] = { 0, 0, 0 };
  std::sscanf(text.c_str(), "#%2x%2x%2x", rgb, rgb + 1, rgb + 2);
  values.insert(values.end(), { rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0 });
}

// What a data set is made of: the proxy at its input Input, or null.
vtkSMProxy* InputOf(vtkSMProxy* proxy)
{
  return vtkSMPropertyHelper(proxy, "Input", /*quiet=*/true).GetAsProxy();
}

// The factor for z that an entry in Python has found, here or upstream; else the one with which relief
// takes about a sixth of the size.
double ExaggerationOf(vtkSMSourceProxy* source, const double bounds[6])
{
  for (vtkSMProxy* proxy = source; proxy; proxy = InputOf(proxy))
  {
    if (vtkSMProperty* found = proxy->GetProperty("VerticalExaggeration"))
    {
      proxy->UpdatePropertyInformation(found);
      return vtkSMPropertyHelper(found).GetAsDouble();
    }
  }
  const double relief = bounds[5] - bounds[4];
  const double size = std::sqrt((bounds[1] - bounds[0]) * (bounds[3] - bounds[2]));
  return relief > 0.0 && size > relief ? std::max(1.0, std::round(0.17 * size / relief)) : 1.0;
}

// The third number of Scale of a representation.
double ScaleOf(vtkSMProxy* representation)
{
  return vtkSMPropertyHelper(representation, "Scale", /*quiet=*/true).GetAsDouble(2);
}

// The data that a view shows.
std::vector<vtkSMProxy*> ShownIn(vtkSMProxy* view)
{
  std::vector<vtkSMProxy*> shown;
  const vtkSMPropertyHelper all(view, "Representations", /*quiet=*/true);
  for (unsigned int i = 0; i < all.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* one = all.GetAsProxy(i);
    if (one && InputOf(one) && one->GetProperty("Scale") &&
      vtkSMPropertyHelper(one, "Visibility", /*quiet=*/true).GetAsInt())
    {
      shown.push_back(one);
    }
  }
  return shown;
}

// Whether a view looks straight down with y upwards, as a new one does.
bool LooksStraightDown(vtkSMRenderViewProxy* view)
{
  const double* direction = view->GetActiveCamera()->GetDirectionOfProjection();
  const double* up = view->GetActiveCamera()->GetViewUp();
  return direction[2] < -1.0 + 1e-9 && up[1] > 1.0 - 1e-9;
}

// Whether nobody has placed the camera of a view yet.
bool LooksAtOrigin(vtkSMRenderViewProxy* view)
{
  const double* focus = view->GetActiveCamera()->GetFocalPoint();
  return vtkMath::Norm(focus) == 0.0;
}

// Looks at what is in bounds obliquely.
void PlaceCamera(vtkSMRenderViewProxy* view, vtkPVXMLElement* xml, double bounds[6])
{
  double bearing = 0.0, height = 0.0;
  xml->GetScalarAttribute("bearing", &bearing);
  xml->GetScalarAttribute("height", &height);
  bearing = vtkMath::RadiansFromDegrees(bearing);
  height = vtkMath::RadiansFromDegrees(height);
  vtkCamera* camera = view->GetActiveCamera();
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetPosition(
    std::cos(height) * std::sin(bearing), std::cos(height) * std::cos(bearing), std::sin(height));
  camera->SetViewUp(0.0, 0.0, 1.0);
  view->ResetCamera(bounds);
  view->SynchronizeCameraProperties();
}

// Scales z as what a view shows already; where that is nothing, or the input alone, as suits the relief.
// A view that nobody has turned then looks at it obliquely. A scale that has been chosen stays.
void ScaleAndPlace(vtkSMProxy* representation, vtkSMSourceProxy* source, vtkPVXMLElement* xml,
  vtkMTimeType begun, vtkSMRenderViewProxy* view, double bounds[6])
{
  const std::vector<vtkSMProxy*> shown = view ? ShownIn(view) : std::vector<vtkSMProxy*>();
  const auto scaled =
    std::find_if(shown.begin(), shown.end(), [](vtkSMProxy* one) { return ScaleOf(one) != 1.0; });
  const bool isFirst = std::all_of(shown.begin(), shown.end(),
                         [&](vtkSMProxy* one) { return InputOf(one) == InputOf(source); }) &&
    scaled == shown.end();
  const bool isNew =
    isFirst && view && LooksStraightDown(view) && (LooksAtOrigin(view) || !shown.empty());
  double factor = scaled == shown.end() ? 1.0 : ScaleOf(*scaled);
  if (isNew || (isFirst && shown.empty()))
  {
    factor = ExaggerationOf(source, bounds);
  }
  if (representation->GetProperty("Scale")->GetMTime() < begun)
  {
    const double scale[3] = { 1.0, 1.0, factor };
    vtkSMPropertyHelper(representation, "Scale").Set(scale, 3);
  }
  if (isNew)
  {
    bounds[4] *= ScaleOf(representation);
    bounds[5] *= ScaleOf(representation);
    PlaceCamera(view, xml, bounds);
  }
}

// A colour map of elevations, unless one has been chosen.
void ColourByElevation(vtkSMProxy* colours, vtkPVXMLElement* xml, const double range[2])
{
  if (!colours->GetProperty("RGBPoints")->IsValueDefault())
  {
    return;
  }
  const bool isSea = range[1] <= 0.0 && range[0] < 0.0;
  const std::vector<std::string> stops = WordsOf(xml, isSea ? "sea" : "land", ' ');
  const double step = (range[1] > range[0] ? range[1] - range[0] : 1.0) / (stops.size() - 1);
  std::vector<double> values;
  for (const std::string& stop : stops)
  {
    values.push_back(range[0] + values.size() / 4 * step);
    AddColour(stop, values);
  }
  vtkSMPropertyHelper(colours, "ColorSpace").Set("Lab");
  vtkSMPropertyHelper points(colours, "RGBPoints");
  points.SetNumberOfElements(static_cast<unsigned int>(values.size()));
  points.Set(values.data(), static_cast<unsigned int>(values.size()));
  colours->UpdateVTKObjects();
}

// Plain numbers next to the colours, with as many digits as the range needs. The bar stays hidden until
// ParaView shows it.
void WritePlainNumbers(vtkSMProxy* colours, vtkSMProxy* view, const double range[2])
{
  if (vtkSMTransferFunctionProxy::FindScalarBarRepresentation(colours, view))
  {
    return;
  }
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMProxy* bar = manager->GetScalarBarRepresentation(colours, view);
  const double span = range[1] > range[0] ? range[1] - range[0] : 1.0;
  const int digits = std::max(0, std::min(9, 1 - static_cast<int>(std::floor(std::log10(span)))));
  // ParaView 6.1 writes numbers by std::format.
  const bool hasBraces =
    std::strchr(vtkSMPropertyHelper(bar, "RangeLabelFormat").GetAsString(), '{') != nullptr;
  const std::string number = "." + std::to_string(digits) + "f";
  const std::string format = hasBraces ? "{:" + number + "}" : "%" + number;
  vtkSMPropertyHelper(bar, "AutomaticLabelFormat").Set(0);
  vtkSMPropertyHelper(bar, "LabelFormat").Set(format.c_str());
  vtkSMPropertyHelper(bar, "RangeLabelFormat").Set(format.c_str());
  vtkSMPropertyHelper(bar, "Visibility").Set(0);
  bar->UpdateVTKObjects();
}

// Colours elevations, if there are any, next to plain numbers in a view.
void ShowElevations(vtkPVDataInformation* data, vtkSMSessionProxyManager* proxies,
  vtkPVXMLElement* xml, vtkSMProxy* view)
{
  if (vtkPVArrayInformation* heights = data->GetArrayInformation(ARRAY, vtkDataObject::POINT))
  {
    const double* range = heights->GetComponentFiniteRange(0);
    vtkNew<vtkSMTransferFunctionManager> manager;
    vtkSMProxy* colours = manager->GetColorTransferFunction(ARRAY, proxies);
    ColourByElevation(colours, xml, range);
    if (view)
    {
      WritePlainNumbers(colours, view, range);
    }
  }
}

// Colours the words of a cell array, each in its colour, unless that has been chosen.
void ColourByWords(vtkSMProxy* representation, vtkPVXMLElement* xml)
{
  // Not by the static function of this name, which ParaView 5.13 has moved.
  auto* const coloured = vtkSMPVRepresentationProxy::SafeDownCast(representation);
  if (!coloured)
  {
    return;
  }
  coloured->SetScalarColoring(xml->GetAttribute("array"), vtkDataObject::CELL);
  vtkSMProxy* colours = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  vtkSMPropertyHelper annotations(colours, "Annotations");
  if (annotations.GetNumberOfElements() > 0)
  {
    return;
  }
  std::vector<double> values;
  for (const std::string& word : WordsOf(xml, "words", ','))
  {
    // The value, and what is shown for it.
    annotations.Set(annotations.GetNumberOfElements(), word.c_str());
    annotations.Set(annotations.GetNumberOfElements(), word.c_str());
  }
  for (const std::string& colour : WordsOf(xml, "colours", ' '))
  {
    AddColour(colour, values);
  }
  vtkSMPropertyHelper(colours, "IndexedLookup").Set(1);
  vtkSMPropertyHelper(colours, "IndexedColors")
    .Set(values.data(), static_cast<unsigned int>(values.size()));
  colours->UpdateVTKObjects();
}

// Has the panel show the results of each update. ParaView asks for them before it.
void AskForResults(vtkObject* representation, unsigned long, void*, void*)
{
  if (vtkSMProxy* source = InputOf(vtkSMProxy::SafeDownCast(representation)))
  {
    source->UpdatePropertyInformation();
  }
}

// Called once for each representation that is made, before it is in its view, which is the active one.
class vtkSMElevationLook : public vtkSMProxyInitializationHelper
{
public:
  static vtkSMElevationLook* New();
  vtkTypeMacro(vtkSMElevationLook, vtkSMProxyInitializationHelper);

  void PostInitializeProxy(
    vtkSMProxy* representation, vtkPVXMLElement* xml, vtkMTimeType begun) override
  {
    const vtkSMPropertyHelper input(representation, "Input");
    auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
    vtkPVDataInformation* data =
      source ? source->GetDataInformation(input.GetOutputPort()) : nullptr;
    vtkNew<vtkCallbackCommand> update;
    update->SetCallback(AskForResults);
    representation->AddObserver(vtkCommand::UpdateDataEvent, update);
    if (!data || data->GetNumberOfPoints() == 0)
    {
      return;
    }
    double bounds[6];
    data->GetBounds(bounds);
    vtkSMSessionProxyManager* proxies = representation->GetSessionProxyManager();
    vtkSMProxySelectionModel* active = proxies->GetSelectionModel("ActiveView");
    auto* view = vtkSMRenderViewProxy::SafeDownCast(active ? active->GetCurrentProxy() : nullptr);
    ScaleAndPlace(representation, source, xml, begun, view, bounds);
    if (xml->GetAttribute("line_width"))
    {
      double width = 1.0;
      xml->GetScalarAttribute("line_width", &width);
      vtkSMPropertyHelper(representation, "LineWidth").Set(width);
    }
    if (xml->GetAttribute("array"))
    {
      ColourByWords(representation, xml);
    }
    if (xml->GetAttribute("land"))
    {
      ShowElevations(data, proxies, xml, view);
    }
    representation->UpdateVTKObjects();
  }
};
vtkStandardNewMacro(vtkSMElevationLook);

/** Hides arrays in charts, unless they are asked for. Newer ParaViews have a list of settings for that. */
template <typename Domain, typename Settings>
auto HideInCharts(const char* pattern, int)
  -> decltype(Domain::AddSeriesVisibilityDefault(pattern, false))
{
  return Domain::AddSeriesVisibilityDefault(pattern, false);
}

template <typename Domain, typename Settings>
void HideInCharts(const char* pattern, long)
{
  Settings* const settings = Settings::GetInstance();
  const int count = settings->GetNumberOfChartsHiddenAttributes();
  settings->SetNumberOfChartsHiddenAttributes(count + 1);
  settings->SetChartsHiddenAttributes(count, pattern);
}
} // namespace

void ElevationLook()
{
  // On the axis of elevations, an error near 0 would leave the profile of a mountain a straight line.
  HideInCharts<vtkSMChartSeriesSelectionDomain, vtkPVRepresentedArrayListSettings>(
    "^FilledError$", 0);
  vtkClientServerInterpreterInitializer::GetGlobalInterpreter()->AddNewInstanceFunction(
    "vtkSMElevationLook", [](void*) -> vtkObjectBase* { return vtkSMElevationLook::New(); });
}
