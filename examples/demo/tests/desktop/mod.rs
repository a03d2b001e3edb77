//! A virtual display with the demo on it, and a mouse.

use std::fs;
use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// No answer takes that long, not even the first, for which shaders are compiled.
const PATIENCE: Duration = Duration::from_secs(120);

/// A picture that has not changed for so long has come to rest.
const REST: Duration = Duration::from_millis(1000);

/// Between two looks at the screen: far less than a frame takes.
const LOOK: Duration = Duration::from_millis(2);

pub struct Desktop {
    server: Child,
    demo: Option<Child>,
    display: String,
    folder: PathBuf,
}

impl Desktop {
    /// Opens the demo as a saved file says; `None`, and says why, where that is not possible.
    pub fn open([width, height]: [u32; 2], saved: &str) -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            if Command::new(program).arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
                println!("not checked: there is no {program} (Debian, Ubuntu: apt-get install xvfb xdotool)");
                return None;
            }
        }
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("asvgf-desktop-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).expect("a folder for the screen");
        // The server chooses a number that is free and tells it. The screen is a file in that folder.
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0", &format!("{width}x{height}x24"), "-fbdir"])
            .arg(&folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("a display");
        let mut number = String::new();
        let told = BufReader::new(server.stdout.take().expect("a pipe")).read_line(&mut number);
        let mut desktop = Self { server, demo: None, display: format!(":{}", number.trim()), folder };
        assert!(told.is_ok() && !number.trim().is_empty(), "Xvfb has ended");
        let state = desktop.folder.join("state.json");
        fs::write(&state, saved).expect("a file");
        let demo = Command::new(env!("CARGO_BIN_EXE_asvgf-demo"))
            .args(["--size", &format!("{width}x{height}"), "--state"])
            .arg(state)
            .env("DISPLAY", &desktop.display)
            .env_remove("WAYLAND_DISPLAY")
            .spawn();
        desktop.demo = Some(demo.expect("the demo starts"));
        Some(desktop)
    }

    /// Does what xdotool is told.
    pub fn act(&self, words: &str) {
        let done = Command::new("xdotool").args(words.split(' ')).env("DISPLAY", &self.display).status();
        assert!(done.is_ok_and(|status| status.success()), "xdotool {words}");
    }

    /// Moves the pointer to a pixel.
    pub fn point(&self, [x, y]: [u32; 2]) {
        self.act(&format!("mousemove {x} {y}"));
    }

    /// What is on the screen.
    pub fn frame(&self) -> Frame {
        Frame(fs::read(self.folder.join("Xvfb_screen0")).expect("a screen"))
    }

    /// Waits until what is looked at has come to rest, and is not of one colour. Returns it.
    pub fn settle<T: PartialEq + Varied>(&self, look: impl Fn(&Frame) -> T) -> T {
        let start = Instant::now();
        let (mut last, mut since) = (look(&self.frame()), start);
        while since.elapsed() < REST || !last.is_varied() {
            assert!(start.elapsed() < PATIENCE, "it does not come to rest");
            sleep(LOOK);
            let now = look(&self.frame());
            if now != last {
                (last, since) = (now, Instant::now());
            }
        }
        last
    }

    /// How long it takes from an act to the first change of what is looked at.
    pub fn answer<T: PartialEq>(&self, words: &str, look: impl Fn(&Frame) -> T) -> Duration {
        let before = look(&self.frame());
        let start = Instant::now();
        self.act(words);
        while look(&self.frame()) == before {
            assert!(start.elapsed() < PATIENCE, "no answer to {words}");
            sleep(LOOK);
        }
        start.elapsed()
    }
}

impl Drop for Desktop {
    fn drop(&mut self) {
        for child in self.demo.iter_mut().chain([&mut self.server]) {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Whether there is anything to see.
pub trait Varied {
    fn is_varied(&self) -> bool;
}

impl Varied for Vec<[u8; 3]> {
    fn is_varied(&self) -> bool {
        self.iter().any(|pixel| *pixel != self[0])
    }
}

/// Columns that were found.
impl Varied for Vec<u32> {
    fn is_varied(&self) -> bool {
        !self.is_empty()
    }
}

/// A screen: a file in the format XWD, big-endian, its pixels as the server has them.
pub struct Frame(Vec<u8>);

impl Frame {
    /// Pixels of a part, row by row.
    pub fn pixels(&self, columns: Range<u32>, rows: Range<u32>) -> Vec<[u8; 3]> {
        let word = |i: usize| {
            let bytes = self.0[4 * i..].first_chunk::<4>().expect("a header");
            u32::from_be_bytes(*bytes) as usize
        };
        // header_size, bytes_per_line, ncolors (12 bytes each) of the header.
        let (header, line, colors) = (word(0), word(12), word(19));
        let start = header + 12 * colors;
        let pixel = |x: u32, y: u32| {
            let at = start + y as usize * line + 4 * x as usize;
            [self.0[at + 2], self.0[at + 1], self.0[at]]
        };
        rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }
}
