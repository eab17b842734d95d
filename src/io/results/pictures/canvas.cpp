// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/canvas.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <string>

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace stylet::results {
namespace {

Error no_picture(const std::string& what) {
  return failure("pictures", what, "Install the packages libegl1, libegl-mesa0 and libgl1-mesa-dri");
}

/// Reduces a picture by averaging squares of kOversampling × kOversampling pixels.
void average_down(const vtkUnsignedCharArray& large, vtkImageData& picture) {
  constexpr int k = Canvas::kOversampling;
  picture.SetDimensions(Canvas::kWidth, Canvas::kHeight, 1);
  picture.AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < Canvas::kHeight; ++y) {
    for (int x = 0; x < Canvas::kWidth; ++x) {
      auto* pixel = static_cast<unsigned char*>(picture.GetScalarPointer(x, y, 0));
      for (int c = 0; c < 3; ++c) {
        int sum = k * k / 2;
        for (int j = 0; j < k; ++j) {
          for (int i = 0; i < k; ++i) {
            const vtkIdType at = static_cast<vtkIdType>(k * y + j) * (k * Canvas::kWidth) + (k * x + i);
            sum += const_cast<vtkUnsignedCharArray&>(large).GetValue(3 * at + c);  // VTK's getters are not const
          }
        }
        pixel[c] = static_cast<unsigned char>(sum / (k * k));
      }
    }
  }
}

}  // namespace

/// An OpenGL 3.2 core context that draws only into its own framebuffers. It is a member of Canvas::Parts and therefore
/// not in the anonymous namespace.
class SurfacelessContext {
 public:
  /// Opens the context. @return the error, or empty
  std::string open() {
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY) return "EGL has no surfaceless display";
    if (eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) return "EGL cannot be initialised";
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return "EGL offers no OpenGL";
    constexpr std::array<EGLint, 7> kWanted{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kWanted.data());
    if (context_ == EGL_NO_CONTEXT) return "EGL offers no OpenGL 3.2";
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
      return "the OpenGL context cannot be used without a surface";
    }
    return {};
  }
  SurfacelessContext() = default;
  SurfacelessContext(const SurfacelessContext&) = delete;
  SurfacelessContext& operator=(const SurfacelessContext&) = delete;
  ~SurfacelessContext() {
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

struct Canvas::Parts {
  SurfacelessContext context;  ///< first member, because it must outlive the window
  vtkNew<vtkGenericOpenGLRenderWindow> window;
};

Canvas::Canvas(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Canvas::~Canvas() = default;

Result<std::unique_ptr<Canvas>> Canvas::open() {
  auto parts = std::make_unique<Parts>();
  if (const std::string reason = parts->context.open(); !reason.empty()) return no_picture(reason);
  // VTK would report that GLEW finds no X display. The OpenGL functions are loaded nevertheless, and draw() checks its
  // result.
  vtkObject::GlobalWarningDisplayOff();
  vtkGenericOpenGLRenderWindow& window = *parts->window;
  vtkNew<vtkCallbackCommand> is_current;
  is_current->SetCallback([](vtkObject*, unsigned long, void*, void* answer) { *static_cast<bool*>(answer) = true; });
  window.AddObserver(vtkCommand::WindowIsCurrentEvent, is_current);
  window.SetOwnContext(0);
  window.SetSupportsOpenGL(1);
  window.SetReadyForRendering(true);
  window.SetFrameBlitModeToNoBlit();  // there is no window to copy to
  window.SetMultiSamples(0);
  window.SetAlphaBitPlanes(1);
  window.SetSize(kOversampling * kWidth, kOversampling * kHeight);
  window.SetNumberOfLayers(1);
  return std::unique_ptr<Canvas>(new Canvas(std::move(parts)));
}

Result<std::string> Canvas::draw(std::span<const vtkSmartPointer<vtkRenderer>> layers) {
  vtkGenericOpenGLRenderWindow& window = *parts_->window;
  for (const auto& layer : layers) window.AddRenderer(layer);
  window.Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  const int read = window.GetPixelData(0, 0, kOversampling * kWidth - 1, kOversampling * kHeight - 1, 0, pixels, 0);
  for (const auto& layer : layers) window.RemoveRenderer(layer);
  constexpr vtkIdType kValues = 3LL * kOversampling * kWidth * kOversampling * kHeight;
  if (read == 0 || pixels->GetNumberOfValues() != kValues) return no_picture("OpenGL gave no pixels back");
  const unsigned char* values = pixels->GetPointer(0);
  if (std::all_of(values, values + kValues, [&](unsigned char v) { return v == values[0]; })) {
    return no_picture("OpenGL drew nothing");
  }
  vtkNew<vtkImageData> picture;
  average_down(*pixels, *picture);
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(picture);
  writer->Write();
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  if (bytes == nullptr || bytes->GetNumberOfValues() == 0) return no_picture("the PNG encoder failed");
  const unsigned char* begin = const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0);  // VTK's getters are not const
  return std::string(begin, begin + bytes->GetNumberOfValues());
}

}  // namespace stylet::results
