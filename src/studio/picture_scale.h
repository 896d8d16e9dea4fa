#pragma once
// Resolution of live pictures while something moves: as fine as the renderer keeps up with.

namespace gloam::studio {

/// Steps of half the pixels each. Down at once where pictures come too slowly; up by one step after
/// a time of pictures that keep up, which doubles each time that the finer step did not.
class PictureScale {
 public:
  static constexpr double kTargetInterval = 0.1;  ///< [s] between two pictures, at most

  /// Share of the full width and height.
  double scale() const;
  /// Time that pictures take [s]: the mean over some of them. `keeps_up`: none was left out.
  void add(double seconds, bool keeps_up);

 private:
  int level_ = 0;         // scale = sqrt(1/2) to the power of it
  double good_ = 0;       // time since the last change in which pictures kept up [s]
  double patience_ = 2;   // of good_ before the next step up [s]
  bool climbed_ = false;  // the last change was a step up
};

}  // namespace gloam::studio
