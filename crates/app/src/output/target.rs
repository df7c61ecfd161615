//! Files that appear only once they are complete, and standard output that may be closed at any time.

use crate::error::AppError;
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Whether `path` stands for standard output.
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// Refuses a file whose name does not end as its form does, such as in `.svg`; what is no regular file may be called anything.
pub fn require_extension(path: &Path, extension: &str) -> Result<(), AppError> {
    let is_right = path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if is_right || is_stdout(path) || path.metadata().is_ok_and(|data| !data.is_file() && !data.is_dir()) {
        return Ok(());
    }
    let shown = path.display();
    Err(AppError::Usage(format!("{shown}: the form follows from the extension, which is .{extension}")))
}

/// What went wrong with a file at `path`, without the name of the temporary one beside it, which the user has not given.
fn plain(path: &Path, error: &io::Error) -> io::Error {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.and_then(|folder| folder.metadata().err()).unwrap_or_else(|| error.kind().into())
}

/// Where bytes go.
pub struct Target {
    shown: String,
    writer: Writer,
}

enum Writer {
    Stdout(BufWriter<io::Stdout>),
    /// Standard output that its reader has closed: what is written is gone, and that is no error.
    Closed,
    /// A new file beside the one it will replace.
    Beside {
        file: BufWriter<NamedTempFile>,
        path: PathBuf,
    },
    /// Something that is no regular file, such as /dev/null or a named pipe: it cannot be replaced.
    Direct(BufWriter<File>),
}

/// Whether more bytes are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Demand {
    Open,
    Closed,
}

impl Target {
    /// Opens `path`; `-` is standard output.
    pub fn open(path: &Path) -> Result<Self, AppError> {
        let shown = if is_stdout(path) { "standard output".to_owned() } else { path.display().to_string() };
        match Writer::open(path) {
            Ok(writer) => Ok(Self { shown, writer }),
            Err(source) => Err(AppError::Write { path: shown, source: plain(path, &source) }),
        }
    }

    /// What the user calls it.
    pub fn shown(&self) -> &str {
        &self.shown
    }

    /// The temporary file, if there is one: what an interrupted program has to clear away.
    pub fn temporary(&self) -> Option<&Path> {
        match &self.writer {
            Writer::Beside { file, .. } => Some(file.get_ref().path()),
            _ => None,
        }
    }

    /// Writes all of `bytes`.
    pub fn write(&mut self, bytes: &[u8]) -> Result<Demand, AppError> {
        let written = self.writer.write_all(bytes);
        self.settle(written)
    }

    /// Completes the output: only now does a file appear under its name.
    pub fn finish(mut self) -> Result<(), AppError> {
        let flushed = self.writer.flush();
        self.settle(flushed)?;
        if let Writer::Beside { file, path } = self.writer {
            let renamed =
                file.into_inner().map_err(|e| e.into_error()).and_then(|f| f.persist(path).map_err(|e| e.error));
            renamed.map_err(|source| AppError::Write { path: self.shown, source })?;
        }
        Ok(())
    }

    fn settle(&mut self, result: io::Result<()>) -> Result<Demand, AppError> {
        match result {
            Err(e) if e.kind() == ErrorKind::BrokenPipe => {
                // What is still buffered must not be tried again when the writer goes.
                if let Writer::Stdout(out) = std::mem::replace(&mut self.writer, Writer::Closed) {
                    let _ = out.into_parts();
                }
                Ok(Demand::Closed)
            }
            Err(source) => Err(AppError::Write { path: self.shown.clone(), source }),
            Ok(()) if matches!(self.writer, Writer::Closed) => Ok(Demand::Closed),
            Ok(()) => Ok(Demand::Open),
        }
    }
}

/// For writers of forms that know nothing of a demand.
impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write_all(bytes).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Writer::Stdout(out) => out.write(bytes),
            Writer::Closed => Ok(bytes.len()),
            Writer::Beside { file, .. } => file.write(bytes),
            Writer::Direct(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Writer::Stdout(out) => out.flush(),
            Writer::Closed => Ok(()),
            Writer::Beside { file, .. } => file.flush(),
            Writer::Direct(file) => file.flush(),
        }
    }
}

impl Writer {
    fn open(path: &Path) -> io::Result<Self> {
        if is_stdout(path) {
            return Ok(Self::Stdout(BufWriter::new(io::stdout())));
        }
        // Through a link the file it leads to is replaced, not the link.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        match std::fs::metadata(&path) {
            Ok(meta) if meta.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Ok(meta) if !meta.is_file() => {
                return File::options().write(true).open(&path).map(BufWriter::new).map(Self::Direct);
            }
            _ => {}
        }
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".carom-").suffix(".part");
        #[cfg(unix)]
        {
            // As any new file: readable to others where the user's mask allows it.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = BufWriter::new(builder.tempfile_in(folder)?);
        Ok(Self::Beside { file, path })
    }
}
