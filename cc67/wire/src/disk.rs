//! File requests of programs on the board. Source: host-protocol.md section 6.

/// The number of file bytes per line to the board.
const BYTES_PER_LINE: usize = 80;

/// Serves the files of programs on the board.
pub trait PcFiles: Send {
    /// Executes a request with this code; returns the answer, if there is one.
    fn request(&mut self, code: u8, text: &[u8]) -> Option<DiskAnswer>;
}

/// The answer to a request that reads a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DiskAnswer {
    /// A line of the file, without its end.
    Line(Vec<u8>),
    /// The end of the file.
    End,
    /// The file cannot be read, or none is open.
    Failure,
}

impl DiskAnswer {
    /// The lines for the board: a command and its data lines.
    pub(crate) fn lines(&self) -> Vec<Vec<u8>> {
        match self {
            Self::Line(line) => {
                let command = format!("ReadDiskData 1 {}", line.len()).into_bytes();
                let data = line.chunks(BYTES_PER_LINE).map(hexadecimal);
                std::iter::once(command).chain(data).collect()
            }
            Self::End => vec![b"ReadDiskData 3 0".to_vec()],
            Self::Failure => vec![b"ReadDiskData 2 0".to_vec()],
        }
    }
}

/// Bytes as two hexadecimal digits each, separated by spaces.
pub(crate) fn hexadecimal(bytes: &[u8]) -> Vec<u8> {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    let digit = |value: u8| DIGITS.get(usize::from(value)).copied().unwrap_or(b'0');
    let mut text: Vec<u8> =
        bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 0xF), b' ']).collect();
    text.pop();
    text
}

/// A PC without files: every file that is opened for reading is missing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl PcFiles for NoFiles {
    fn request(&mut self, code: u8, _: &[u8]) -> Option<DiskAnswer> {
        matches!(code, 4 | 5).then_some(DiskAnswer::Failure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_file_is_sent_as_the_vendors_library_sends_it() {
        let lines = DiskAnswer::Line(b"first line".to_vec()).lines();
        assert_eq!(lines, [&b"ReadDiskData 1 10"[..], b"66 69 72 73 74 20 6C 69 6E 65"]);
        assert_eq!(DiskAnswer::Line(Vec::new()).lines(), [b"ReadDiskData 1 0"]);
        assert_eq!(DiskAnswer::Line(vec![0xAB; 81]).lines().len(), 3);
        assert_eq!(DiskAnswer::End.lines(), [b"ReadDiskData 3 0"]);
    }
}
