//! How bakes get on: a bar each on a terminal, a line at begin and end elsewhere; and the times of their stages.

use crate::layout::settings::Settings;
use crate::machine::cpu_time::cpu_time;
use crate::machine::output;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// Name of a stage, wall time, processor time of the whole process meanwhile.
pub(super) type Stage = (String, Duration, Duration);

/// Where all bakes of a run show themselves.
pub struct Progress {
    /// On a terminal.
    bars: Option<MultiProgress>,
    quiet: bool,
}

impl Progress {
    pub fn new(quiet: bool) -> Self {
        let terminal = !quiet && output::watched();
        Progress { bars: terminal.then(MultiProgress::new), quiet }
    }

    /// Talk: a line on stderr, above the bars; none when quiet.
    pub fn say(&self, line: &str) {
        if !self.quiet {
            self.always(line);
        }
    }

    /// A line that being quiet does not keep back.
    pub fn always(&self, line: &str) {
        let write = || output::say(line);
        match &self.bars {
            Some(bars) => bars.suspend(write),
            None => write(),
        }
    }

    /// A bake of so many stages begins; `about` is told where there are no bars.
    pub fn begin(&self, name: &str, stages: usize, about: &str) -> Clock {
        let bar = match &self.bars {
            Some(bars) => bars.add(ProgressBar::new(stages as u64)),
            None => ProgressBar::hidden(),
        };
        if let Ok(style) = ProgressStyle::with_template("{prefix:16} {bar:24} {elapsed:>4} {msg}") {
            bar.set_style(style);
        }
        bar.set_prefix(name.to_string());
        if self.bars.is_some() {
            bar.enable_steady_tick(Duration::from_millis(250));
        } else {
            self.say(&format!("{name}: begins{about}"));
        }
        Clock { bar, start: Instant::now(), stages: Vec::new(), current: None }
    }

    /// What became of a bake, where no bar has shown it.
    pub fn end(&self, name: &str, how: &str) {
        if self.bars.is_none() {
            self.say(&format!("{name}: {how}"));
        }
    }
}

/// Number of stages of a bake: what its bar counts.
pub(super) fn stages(settings: &Settings) -> usize {
    const ALWAYS: usize = 8;
    let waters = usize::from(!settings.waters.list.is_empty());
    ALWAYS + settings.layouts.len() + waters
}

/// Times the stages of one bake and moves its bar.
pub struct Clock {
    bar: ProgressBar,
    start: Instant,
    stages: Vec<Stage>,
    current: Option<(String, Instant, Duration)>,
}

impl Clock {
    pub fn stage(&mut self, name: &str) {
        self.close();
        self.bar.set_message(name.to_string());
        self.current = Some((name.to_string(), Instant::now(), cpu_time()));
    }

    fn close(&mut self) {
        if let Some((name, wall, cpu)) = self.current.take() {
            self.stages.push((name, wall.elapsed(), cpu_time().saturating_sub(cpu)));
            self.bar.inc(1);
        }
    }

    /// Time since the bake began.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// The stages, with their sum at the end.
    pub fn finish(mut self) -> Vec<Stage> {
        self.close();
        let all = self.stages.iter().map(|s| s.2).sum();
        self.stages.push(("all".into(), self.start.elapsed(), all));
        std::mem::take(&mut self.stages)
    }
}

impl Drop for Clock {
    /// A bake that failed takes its bar away too.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
